#pragma once

#include <vector>

#include "motion/vector.h"
#include "remomask/motion.h"

namespace remomask::kinematics {

/// The joints of one leg and the lengths of its two bones, metres.
struct Leg {
  int hip = 0, knee = 0, ankle = 0, toe = 0;
  double upper = 0, lower = 0;
};

/// The leg that ends in `feet` (ankle first, toe last, as in Skeleton), with the bone lengths of
/// frame `frame` of `motion`.
Leg leg_of(const std::vector<int>& feet, const Skeleton& skeleton, const Motion& motion, int frame);

/// Moves the foot of one frame by `shift`. The knee follows by two-bone inverse kinematics, so bone
/// lengths stay; ankle and toe keep their direction. A shift out of reach is shortened.
void move_foot(Motion& motion, int frame, const Leg& leg, const Vec3& shift);

}  // namespace remomask::kinematics
