#pragma once

#include <optional>

#include "rig/skeleton_map.h"

namespace remomask::rig {

/// The map of a file that was written here, with joint names of any preset: its joints are the 22
/// and a root above them, none else; or the 22 are among them with our lengths of arms and legs, as
/// in .fbx files, which have no joint above, and after another program has added some.
std::optional<SkeletonMap> own_skeleton_map(const SkeletonView& skeleton);

}  // namespace remomask::rig
