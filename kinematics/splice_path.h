#pragma once

#include <vector>

#include "kinematics/splice.h"
#include "motion/vector.h"

namespace remomask::kinematics {

/// A motion moved to where it belongs.
struct PlacedMotion {
  Motion motion;
  std::vector<Vec3> root_steps;  ///< [frames] step of the root to the next frame, m; last: zero
};

/// The first step of splice_motion(): every frame of `made` turned around +Y,
/// moved and scaled to where it belongs beside `original`. Where parts stay, it
/// lies on them (the heading of hips and shoulders, the centre of their joints,
/// the roots above each other if the root stays); in stretches that are new as a whole, the path
/// goes on from there, see splice_motion(). `root_steps` are those of `made` itself, turned and
/// scaled, also where the root was put elsewhere.
PlacedMotion place_beside(const Motion& original, const Motion& made, const motion::PartMask& mask,
                          const Skeleton& skeleton, const std::vector<double>& lengths,
                          double floor, SpliceReport& report);

}  // namespace remomask::kinematics
