#pragma once

#include "motion/part_mask.h"
#include "remomask/motion.h"

namespace remomask::kinematics {

struct FootLockOptions {
  double height = 0.06;  ///< m above the floor: only a lower toe can stand
  double speed = 0.5;    ///< m/s over the ground: a slower toe stands
  int fade = 4;          ///< frames over which a correction begins and ends
};

/// Holds standing feet still in the frames in which `mask` contains their leg, and lifts feet there
/// out of the floor at height `floor`. All other joints and all other frames stay. Whether a foot
/// stands is read from `guide`, the same motion before it was bent to fit its surroundings, with
/// its floor at y = 0. A foot that stands before the stretch stays where it stood; one that stands
/// after it comes down there. Knees follow by two-bone inverse kinematics, so bone lengths stay;
/// ankle and toe keep their direction.
void lock_feet(Motion& motion, const Motion& guide, double floor, const motion::PartMask& mask,
               const Skeleton& skeleton, const FootLockOptions& options = {});

}  // namespace remomask::kinematics
