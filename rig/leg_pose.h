#pragma once

#include "motion/vector.h"
#include "remomask/rotations.h"

namespace remomask::rig {

/// m/s; a foot whose ankle or toe is slower stands.
constexpr double kStandingSpeed = 0.5;

/// Puts the ankle of one frame to `target` and turns its foot to `foot`, in the world. The knee
/// follows by two-bone inverse kinematics; a target out of reach is shortened. All other joints
/// keep their rotations.
void put_foot(JointRotations& figure, int frame, size_t ankle, const Quat& foot, Vec3 target);

}  // namespace remomask::rig
