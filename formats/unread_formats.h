#pragma once

#include <string>

namespace remomask::formats {

/// Extensions that load_motion() reads, for messages: ".bvh, .amc (with its .asf), ...".
std::string readable_extensions();

/// Why a file with this extension (".c3d") is not read, and what to do.
std::string why_unread(const std::string& extension);

}  // namespace remomask::formats
