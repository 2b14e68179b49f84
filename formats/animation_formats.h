#pragma once

#include <string>
#include <vector>

#include "formats/motion_writing.h"

namespace remomask::formats {

/// The formats that hold joint rotations and know more than a BVH file: .glb, .vrma, .fbx, .npz.
const std::vector<MotionFormat>& animation_formats();

/// Several motions as the animations of one .glb or .fbx file, all with the options of the first
/// job. Throws Error for another extension.
std::string write_together(const std::string& extension, const std::vector<WritingJob>& jobs);

/// The 263 HumanML3D features of a motion as a .npy file.
std::string features_bytes(const Motion& motion);

}  // namespace remomask::formats
