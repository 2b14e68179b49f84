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

/// The first step of splice_motion(): turns every frame of `made` around +Y, moves it and scales it
/// to where it belongs beside `original`. Where parts stay, the frame is laid on them (heading of
/// hips and shoulders, centre of their joints, roots above each other if the root stays). In
/// stretches that are new as a whole, the path continues from there, see splice_motion().
/// `root_steps` are those of `made` itself, turned and scaled, even where the root was placed
/// elsewhere.
PlacedMotion place_beside(const Motion& original, const Motion& made, const motion::PartMask& mask,
                          const Skeleton& skeleton, const std::vector<double>& lengths,
                          double floor, SpliceReport& report);

}  // namespace remomask::kinematics
