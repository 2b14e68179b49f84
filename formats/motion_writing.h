#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "remomask/motion.h"

namespace remomask::formats {

/// Extension of a path in lower case, with its dot; empty if it has none.
std::string lower_extension(const std::string& path);

/// Writes a motion as save_motion() describes, and `sidecar` (a JSON object; null: none) as
/// PATH.json. An old sidecar is removed before the new motion is written, so that no motion ever
/// stands beside the evidence of another one.
void write_motion(const std::string& path, const Motion& motion, const nlohmann::json* sidecar);

}  // namespace remomask::formats
