#include "motion/leg.h"

#include "motion/pose_fit.h"

namespace remomask {

Leg leg_of(const std::vector<int>& feet, const Skeleton& skeleton, const Motion& motion,
           int frame) {
  Leg leg;
  leg.ankle = feet.front();
  leg.toe = feet.back();
  leg.knee = skeleton.parents[static_cast<size_t>(leg.ankle)];
  leg.hip = skeleton.parents[static_cast<size_t>(leg.knee)];
  const auto bone = [&](int a, int b) {
    return (motion.position(frame, a) - motion.position(frame, b)).norm();
  };
  leg.upper = bone(leg.hip, leg.knee);
  leg.lower = bone(leg.knee, leg.ankle);
  return leg;
}

void move_foot(Motion& motion, int frame, const Leg& leg, const Vec3& shift) {
  const Vec3 hip = motion.position(frame, leg.hip), ankle = motion.position(frame, leg.ankle);
  const Vec3 foot = motion.position(frame, leg.toe) - ankle;
  Vec3 end = ankle + shift;
  const Vec3 knee = bend_joint(hip, end, motion.position(frame, leg.knee), leg.upper, leg.lower);
  motion.set(frame, leg.knee, knee);
  motion.set(frame, leg.ankle, end);
  motion.set(frame, leg.toe, end + foot);
}

}  // namespace remomask
