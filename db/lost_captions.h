#pragma once

#include <string>

#include "db/database.h"

namespace remomask::db {

/// A warning about the captions that are lost when `clip` is not stored because its motion is that
/// of `same`; empty if `same` has them all.
std::string lost_captions_warning(const Clip& clip, const Clip& same);

}  // namespace remomask::db
