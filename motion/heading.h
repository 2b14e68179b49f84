#pragma once

#include <vector>

#include "motion/features.h"
#include "motion/vector.h"
#include "remomask/motion.h"

namespace remomask::motion {

/// Vector across the body from right to left hip and shoulder, summed and negated, so that it
/// points to the character's right. With `historical_hips` the hips count in the opposite
/// direction, as in HumanML3D's features.
Vec3 across_body(const Motion& motion, int frame, const Skeleton& skeleton,
                 bool historical_hips = false);

/// Heading of every frame in radians: the angle around +Y from +Z to the facing
/// direction; 0 in frame 0 by definition.
/// official: facing vectors smoothed by a Gaussian of 20 frames, angle in
/// (-pi, pi], frame 0 forced to 0 without turning the others along.
/// fixed: angles unwrapped, smoothed by a Gaussian of 3 frames weighted by how
/// level the body's across axis is, measured from the smoothed heading of
/// frame 0, which is returned in `initial`.
struct Headings {
  std::vector<double> angles;
  double initial = 0;  ///< heading of frame 0 in the motion's own axes (fixed mode), else 0
};
Headings find_headings(const Motion& motion, const Skeleton& skeleton, FeatureMode mode);

}  // namespace remomask::motion
