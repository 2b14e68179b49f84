#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "remomask/generation.h"

namespace remomask {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PhysicalMetrics, finite, bone_length_mean, bone_length_max,
                                   penetration_mean, penetration_max, floating_share, contact_share,
                                   foot_skate, foot_skate_ratio, jerk)
}  // namespace remomask

namespace remomask::pipeline {

/// Measures a canonical motion (floor at y = 0). Bones to which the skeleton
/// gives no length are compared with their length in frame 0. Throws Error when
/// the motion has no frames or other joints than the skeleton.
PhysicalMetrics measure_physical(const Motion& motion, const Skeleton& skeleton);

/// Of many motions: each value is the mean over the finite ones, the maxima are
/// the largest.
struct PhysicalSummary {
  int motions = 0;
  int not_finite = 0;
  PhysicalMetrics values;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PhysicalSummary, motions, not_finite, values)

PhysicalSummary summarise_physical(const std::vector<PhysicalMetrics>& metrics);

}  // namespace remomask::pipeline
