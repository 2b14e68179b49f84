#pragma once

#include <vector>

#include "remomask/rotations.h"

namespace remomask::rig {

/// Takes the way over the ground out of a motion: the root stays above the origin.
void keep_in_place(JointRotations& motion);

/// The heading of each frame in radians: the turn about +Y that is in the pelvis' rotation, without
/// jumps of whole turns. A body that is nearly upside down shows none; there it goes straight on
/// from the frame before to the frame after.
std::vector<double> headings_of(const JointRotations& motion);

/// The motion with one more joint above the pelvis, the first one: it lies on the ground below the
/// standing body, and it alone has positions. It faces +Z; with `heading` it turns with the body.
JointRotations with_root_joint(const JointRotations& motion, bool heading);

}  // namespace remomask::rig
