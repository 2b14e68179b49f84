#include "kinematics/leg.h"
#include "motion/vector.h"

#include "kinematics/pose_fit.h"

namespace remomask::kinematics {

Leg leg_of(const std::vector<int>& feet, const Skeleton& skeleton, const Motion& motion,
           int frame) {
  Leg leg;
  leg.ankle = feet.front();
  leg.toe = feet.back();
  leg.knee = skeleton.parents[static_cast<size_t>(leg.ankle)];
  leg.hip = skeleton.parents[static_cast<size_t>(leg.knee)];
  const auto bone = [&](int a, int b) {
    return (joint_position(motion, frame, a) - joint_position(motion, frame, b)).norm();
  };
  leg.upper = bone(leg.hip, leg.knee);
  leg.lower = bone(leg.knee, leg.ankle);
  return leg;
}

void move_foot(Motion& motion, int frame, const Leg& leg, const Vec3& shift) {
  const Vec3 hip = joint_position(motion, frame, leg.hip),
             ankle = joint_position(motion, frame, leg.ankle);
  const Vec3 foot = joint_position(motion, frame, leg.toe) - ankle;
  Vec3 end = ankle + shift;
  const Vec3 knee =
      bend_joint(hip, end, joint_position(motion, frame, leg.knee), leg.upper, leg.lower);
  set_joint_position(motion, frame, leg.knee, knee);
  set_joint_position(motion, frame, leg.ankle, end);
  set_joint_position(motion, frame, leg.toe, end + foot);
}

}  // namespace remomask::kinematics
