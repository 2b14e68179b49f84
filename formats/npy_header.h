#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace remomask::formats {

/// What the text at the start of a .npy file says.
struct NpyHeader {
  char kind = 'f';  ///< 'f', 'i' or 'u': float, whole number, whole number without sign
  size_t item_bytes = 4;
  bool big_endian = false;
  bool fortran = false;
  std::vector<size_t> shape;
  size_t data_start = 0;  ///< offset in the file
};

/// Throws FileError for a file that is not .npy, and for arrays of anything but numbers.
NpyHeader read_npy_header(std::string_view content, const std::string& path);

}  // namespace remomask::formats
