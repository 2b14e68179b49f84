#pragma once

#include "remomask/motion_file.h"
#include "remomask/rotations.h"

namespace remomask::rig {

/// Takes the way over the ground out of a motion: the root stays above the origin.
void keep_in_place(JointRotations& motion);

/// Makes the last frame the first one again. Heights and rotations are closed; place and heading
/// are, too, unless the motion travels or turns: then they go on from cycle to cycle. The
/// difference is spread over the last second, or over the last half of a shorter motion.
LoopGap close_loop(JointRotations& motion);

/// The motion with one more joint above the pelvis, the first one: it lies on the ground below the
/// standing body, and it alone has positions. It faces +Z; with `heading` it turns with the body.
JointRotations with_root_joint(const JointRotations& motion, bool heading);

}  // namespace remomask::rig
