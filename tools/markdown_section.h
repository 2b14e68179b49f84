#pragma once

#include <string>

namespace remomask::tools {

/// Replaces what stands between the lines "<!-- NAME:begin -->" and
/// "<!-- NAME:end -->" of a text file by `content`. Throws FileError when a line
/// is missing or they stand in the wrong order.
void replace_section(const std::string& path, const std::string& name, const std::string& content);

}  // namespace remomask::tools
