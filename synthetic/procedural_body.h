#pragma once

#include <vector>

#include "motion/vector.h"
#include "remomask/motion.h"

namespace remomask::synthetic {

/// Side 0 is left (+X), side 1 is right.
inline double side_sign(int side) { return side == 0 ? 1.0 : -1.0; }

/// Minimum-jerk step from 0 to 1, constant outside of [0, 1].
double min_jerk(double u);
/// Minimum-jerk step between two times.
double ease(double time, double from, double to);
/// 0, up to 1 within `ramp` after `from`, down to 0 within `ramp` before `to`.
double pulse(double time, double from, double to, double ramp);

/// Angles in degrees; all zero is the arm hanging straight down.
struct ArmPose {
  double flex = 0;    ///< forward and up
  double abduct = 0;  ///< sideways and up
  double across = 0;  ///< inward about the vertical
  double twist = 0;   ///< about the upper arm, outward
  double elbow = 0;   ///< bend
};
ArmPose mix(const ArmPose& a, const ArmPose& b, double weight);

/// A foot by the place of its toe joint. Positive pitch lifts the heel around
/// the toe, negative pitch lifts the toe around the ankle.
struct FootPose {
  Vec3 ball = Vec3::Zero();
  double yaw = 0, pitch = 0;  ///< degrees
  bool planted = true;        ///< bears weight: the pelvis sinks so far that the leg reaches it
};

/// One frame of the body: pelvis, bends of the trunk and head, arms, feet.
struct BodyPose {
  Vec3 pelvis = Vec3::Zero();
  double yaw = 0, pitch = 0, roll = 0;   ///< of the pelvis; pitch forward, roll to the left
  double bend = 0, lean = 0, twist = 0;  ///< of the spine: forward, to the left, left shoulder back
  double nod = 0, look = 0;              ///< of the head: down, to the left
  ArmPose arms[2];
  FootPose feet[2];
};

/// Height of the pelvis of a relaxed stand, metres.
double standing_height();

/// From the toe to the ankle joint of a foot with this yaw and pitch.
Vec3 toe_to_ankle(int side, double yaw, double pitch);

/// Joint positions by forward kinematics of trunk and arms and two-bone inverse
/// kinematics of the legs, with the bone lengths of the uniform skeleton.
Motion solve_body(std::vector<BodyPose> poses);

}  // namespace remomask::synthetic
