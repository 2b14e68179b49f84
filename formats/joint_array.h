#pragma once

#include <string>
#include <vector>

#include "formats/npy.h"
#include "remomask/motion.h"

namespace remomask::formats {

/// The 22 joints of an array of joint positions or HumanML3D features, which other programs store
/// in many shapes: (T, 22, 3), (T, 66), (1, T, 22, 3), MDM's (1, 22, 3, T), and the same of the 24,
/// 52 or 55 joints of SMPL, SMPL-H and SMPL-X, whose first 22 are ours. `name` is what messages
/// call the array: a path, or the path and the name in an .npz file. Adds a warning if joints are
/// left out. Throws FileError that lists the shapes for any other one.
Motion motion_of_array(NpyArray array, const std::string& name, std::vector<std::string>& warnings);

}  // namespace remomask::formats
