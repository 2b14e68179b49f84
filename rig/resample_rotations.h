#pragma once

#include "remomask/rotations.h"

namespace remomask::rig {

/// The motion at another frame rate: rotations interpolated on the sphere, the root's path
/// linearly. Between two frames in which a foot stands (its toe or its ankle hardly moves), the leg
/// is bent so that it goes on standing. The first frame stays, and so does the length in seconds
/// down to the last whole frame. Throws Error unless the rate is 1 to 240.
JointRotations resample_rotations(const JointRotations& motion, double fps);

}  // namespace remomask::rig
