#pragma once

#include <map>
#include <string>
#include <vector>

#include "formats/npy.h"

namespace remomask::formats {

/// The arrays of an .npz file that are asked for.
struct NpzArrays {
  std::map<std::string, NpyArray> arrays;
  std::vector<std::string> names;  ///< of all arrays of the file

  const NpyArray* find(const std::string& name) const;
  /// The first of these that is there; null if none is.
  const NpyArray* find_any(const std::vector<std::string>& wanted) const;
};

/// Reads the arrays called `wanted`; others are neither unpacked nor looked at. What is unpacked is
/// limited to 512 MiB an array and 1 GiB a file, whatever the file says. Throws FileError for a
/// damaged file, and for an array that is wanted and cannot be read.
NpzArrays read_npz(const std::string& path, const std::vector<std::string>& wanted);

}  // namespace remomask::formats
