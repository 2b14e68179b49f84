#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "remomask/motion.h"

namespace remomask::formats {

/// Extension of a path in lower case, with its dot; empty for a path without one.
std::string lower_extension(const std::string& path);

/// Writes a motion as save_motion() says, and `sidecar` (a JSON object; null: none) as PATH.json.
/// An old sidecar goes before the new motion comes, so that no motion stands beside the evidence of
/// another one.
void write_motion(const std::string& path, const Motion& motion, const nlohmann::json* sidecar);

}  // namespace remomask::formats
