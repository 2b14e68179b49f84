#pragma once

#include <cstdint>
#include <string>

namespace remomask::nn {

/// What check_safetensors() found in a file that is in order.
struct CheckedTensors {
  std::string format;  ///< what its metadata call it; empty: nothing
  int64_t tensors = 0;
  bool has_checksums = false;
};

/// Compares a file with its checksums piece by piece, in little memory however large it is. Throws
/// FileError like load_safetensors().
CheckedTensors check_safetensors(const std::string& path);

}  // namespace remomask::nn
