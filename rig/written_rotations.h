#pragma once

#include "remomask/motion_file.h"
#include "remomask/rotations.h"

namespace remomask::rig {

/// What a file of rotations holds: a motion on its rigid skeleton below a root joint, with the
/// names, the frame rate and the root motion that were chosen. Units are left to the format; the
/// result is in metres.
struct RotationsToWrite {
  JointRotations motion;  ///< 23 joints; the root joint comes first and alone has positions
  WrittenMotion written;
};

/// `names` for a choice that is not made.
RotationsToWrite rotations_to_write(const Motion& motion, const MotionWriteOptions& options,
                                    JointNames names = JointNames::mixamo);

}  // namespace remomask::rig
