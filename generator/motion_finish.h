#pragma once

#include "motion/motion.h"

namespace remomask {

/// Gives every bone the length of the skeleton: the root stays, every bone
/// keeps its direction. Decoded positions drift by some millimetres.
void impose_bone_lengths(Motion& motion, const Skeleton& skeleton);

/// Raises a motion whose lowest foot is more than `tolerance` (metres) below
/// the floor, so that this foot touches it. Motions above the floor stay:
/// jumps and climbs are meant to leave it. Returns by how much it was raised.
double lift_to_floor(Motion& motion, const Skeleton& skeleton, double tolerance = 0.01);

}  // namespace remomask
