#pragma once

#include "motion/features.h"

namespace remomask::pipeline {

/// Gives every bone the length of the skeleton: the root stays, every bone
/// keeps its direction. Decoded positions drift by some millimetres.
void impose_bone_lengths(Motion& motion, const Skeleton& skeleton);

/// Gaussian of `sigma` frames over time on every joint; beyond the ends the motion
/// is continued as its own point reflection, so that it keeps its first and
/// last pose. Bones change their length, see impose_bone_lengths().
void smooth_over_time(Motion& motion, double sigma);

/// Takes the sliding out of standing feet: the body is anchored to the feet that
/// `features`, of the same frames, say to stand (anchor_to_feet), then each of
/// them is held where it stands (lock_feet), and swinging feet that brush over the
/// floor are raised (raise_swings). Bone lengths stay.
void hold_feet(Motion& motion, const motion::Features& features, const Skeleton& skeleton);

/// Raises a motion whose lowest foot is more than `tolerance` (metres) below
/// the floor, so that this foot touches it. Motions above the floor stay:
/// jumps and climbs are meant to leave it. Returns by how much it was raised.
double lift_to_floor(Motion& motion, const Skeleton& skeleton, double tolerance = 0.01);

/// The same for long motions: raises only the surroundings of the frames whose
/// lowest foot is below the floor, by a curve that is smooth over about `reach` frames on
/// either side, so that one deep step does not lift minutes. Returns the
/// largest raise, metres.
double lift_to_floor_smoothly(Motion& motion, const Skeleton& skeleton, int reach = 10);

}  // namespace remomask::pipeline
