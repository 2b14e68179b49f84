#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace remomask::formats {

/// A NumPy array of numbers, converted to float32 in C order.
struct NpyArray {
  std::vector<size_t> shape;
  std::vector<float> values;
};

/// Reads a .npy file of up to 512 MiB (format 1, 2 or 3; floats of 2, 4 or 8 bytes and whole
/// numbers, in either byte order; C or Fortran order). Throws FileError for anything else and for
/// missing data. Arrays of Python objects are pickles, which are refused: nothing in a file is
/// executed.
NpyArray read_npy(const std::string& path);
NpyArray parse_npy(std::string_view content, const std::string& path);

/// Content of a format 1.0 .npy file: float32, C order.
std::string format_npy(const NpyArray& array);

}  // namespace remomask::formats
