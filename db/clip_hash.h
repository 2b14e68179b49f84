#pragma once

#include <string>

#include "remomask/motion.h"

namespace remomask::db {

/// Identity of a motion: hash of its positions rounded to 0.1 mm (a ten
/// thousandth of the skeleton's unit), so that the same file gives the same
/// hash on every machine. Throws Error for values that are not finite.
std::string clip_content_hash(const Motion& motion);

}  // namespace remomask::db
