#pragma once

#include "remomask/motion_file.h"
#include "remomask/rotations.h"

namespace remomask::rig {

/// Makes the last frame the first one again. Heights and rotations are closed; place and heading
/// are, too, unless the motion travels or turns: then they go on from cycle to cycle. The
/// difference is spread over the last second, or over the last half of a shorter motion.
///
/// Feet that stand meanwhile stay: a motion that travels ends where its standing feet come to be
/// those of the first frame, and what is left is made up for while a foot swings, or by a step.
LoopGap close_loop(JointRotations& motion);

}  // namespace remomask::rig
