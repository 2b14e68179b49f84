#pragma once

#include <cstdint>
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

/// Limits of what is unpacked, independent of what the file says.
struct NpzLimits {
  uint64_t array_bytes = uint64_t{1} << 28;
  uint64_t file_bytes = uint64_t{1} << 28;
};

/// Reads the arrays called `wanted`; others are neither unpacked nor looked at. Throws FileError
/// for a damaged file, for one that unpacks to more than the limits, and for an array that is
/// wanted and cannot be read.
NpzArrays read_npz(const std::string& path, const std::vector<std::string>& wanted,
                   const NpzLimits& limits = {});

}  // namespace remomask::formats
