#pragma once

#include "motion/part_mask.h"
#include "remomask/motion.h"

namespace remomask::kinematics {

struct FootLockOptions {
  double height = 0.06;  ///< m above the floor: a toe below it can stand
  double speed = 0.5;    ///< m/s over the ground: a toe below it stands
  int fade = 4;          ///< frames over which a correction begins and ends
};

/// Holds standing feet still in the frames in which `mask` has their leg, and
/// lifts feet out of the floor at height `floor` there; all other joints, and
/// all other frames, stay. When a foot stands is read from `guide`, the same
/// motion before it was bent to its surroundings, its floor at y = 0. A foot that
/// stands before the stretch stays where it stood, one that stands behind it
/// comes down there. Knees follow by two-bone inverse kinematics (bone lengths
/// stay), ankle and toe keep their direction.
void lock_feet(Motion& motion, const Motion& guide, double floor, const motion::PartMask& mask,
               const Skeleton& skeleton, const FootLockOptions& options = {});

}  // namespace remomask::kinematics
