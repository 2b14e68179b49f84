#pragma once

#include <string>
#include <vector>

#include "remomask/motion_file.h"
#include "rig/skeleton_view.h"

namespace remomask::formats {

/// The skeleton of a file, with its rest pose and first frame, whether or not a human is
/// recognised in it and whether or not it holds a motion. Of the options, `root` and `animation`
/// count. Throws FileError for a file without one: .npy and .npz hold positions alone.
rig::SkeletonView read_skeleton(const std::string& path, const MotionFileOptions& options,
                                std::vector<std::string>& warnings);

}  // namespace remomask::formats
