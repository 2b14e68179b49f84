#pragma once

#include <optional>

#include "formats/bvh.h"
#include "formats/skeleton_map.h"

namespace remomask::formats {

/// The map of a file that was written here, with joint names of any preset: its joints are the 22
/// and a root above them, none else.
std::optional<SkeletonMap> own_skeleton_map(const Bvh& bvh);

}  // namespace remomask::formats
