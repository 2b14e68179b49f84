#pragma once

#include <string>
#include <vector>

#include "formats/motion_writing.h"

namespace remomask::formats {

/// The formats that hold joint rotations and know more than a BVH file: .glb, .vrma, .fbx, .npz.
const std::vector<MotionFormat>& animation_formats();

/// Whether a file of this ending holds several motions. Throws Error with a remedy if not.
void require_room_for_several(const std::string& path);

/// Writes several motions as the animations of one .glb or .fbx file, all with the options of the
/// first job. What they were made from is in the file alone; an old PATH.json is removed.
WrittenMotion write_together(const std::string& path, const std::vector<WritingJob>& jobs);

/// The 263 HumanML3D features of a motion as a .npy file.
std::string features_bytes(const Motion& motion);

}  // namespace remomask::formats
