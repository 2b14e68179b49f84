#pragma once

#include <vector>

#include "motion/vector.h"

namespace remomask::rig {

/// What a frame says about how the upper bone of a limb is turned about itself.
struct LimbFrame {
  Quat parent;           ///< of the bone that the limb hangs from, in the world
  Vec3 direction;        ///< of the upper bone, in the world
  Vec3 hinge;            ///< axis of the elbow or knee, in the world; of any length
  double certainty = 0;  ///< 0 to 1: how well the frame shows that axis
};

/// How a limb rests: the direction of its upper bone and the axis of its hinge.
struct LimbRest {
  Vec3 direction, hinge;
};

/// World rotations of the upper bone of a limb. They point the bone in its direction. Turns about
/// the bone itself move no joint, so that they are chosen: they follow the hinge where it shows,
/// come back to the least turn from the rest pose where it does not (a straight limb), and change
/// as little as possible from frame to frame (tridiagonal least squares over the motion).
std::vector<Quat> limb_rotations(const std::vector<LimbFrame>& frames, const LimbRest& rest,
                                 double fps);

}  // namespace remomask::rig
