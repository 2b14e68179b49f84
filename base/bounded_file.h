#pragma once

#include <cstdint>
#include <string>

namespace remomask {

/// Whole content of a file that comes from outside. Throws FileError if it cannot be read or
/// holds more than `max_bytes` (a device or a pipe, which may never end: 256 MiB), so that no file
/// exhausts the memory.
std::string read_bounded_file(const std::string& path, uint64_t max_bytes);

}  // namespace remomask
