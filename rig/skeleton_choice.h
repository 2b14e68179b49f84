#pragma once

#include <string>
#include <vector>

#include "rig/skeleton_map.h"

namespace remomask::rig {

struct ChosenSkeletonMap {
  SkeletonMap map;
  std::vector<std::string> warnings;
};

/// The map for a skeleton. `wanted` is the name of a shipped map or a file of maps; empty: found by
/// the joints. Maps of a file override only the skeletons that they fit. Throws FileError (naming
/// `path`) with the names of the file's joints if nothing fits.
ChosenSkeletonMap choose_skeleton_map(const SkeletonView& skeleton, const std::string& wanted,
                                      const std::string& path);

}  // namespace remomask::rig
