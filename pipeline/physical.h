#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "remomask/motion.h"

namespace remomask::pipeline {

/// How far a motion is from what a body can do. Zero is perfect for all but
/// `floating_share`, `contact_share` and `jerk`, which are compared with those of real motions.
struct PhysicalMetrics {
  bool finite = true;           ///< no NaN or infinity; the others are 0 when there is one
  double bone_length_mean = 0;  ///< |length - uniform| / uniform, over bones and frames
  double bone_length_max = 0;   ///< the worst bone of the worst frame
  double penetration_mean = 0;  ///< m below the floor of the lowest foot joint, over frames
  double penetration_max = 0;   ///< m
  double floating_share = 0;    ///< frames whose lowest foot joint is above 10 cm, of all frames
  double contact_share = 0;     ///< steps of a toe with both ends below 5 cm, of all steps
  double foot_skate = 0;        ///< m/s, horizontal speed of the toes in those steps
  double foot_skate_ratio = 0;  ///< share of those steps above 0.5 m/s
  double jerk = 0;              ///< m/s^3, third difference of the positions, mean over joints
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PhysicalMetrics, finite, bone_length_mean, bone_length_max,
                                   penetration_mean, penetration_max, floating_share, contact_share,
                                   foot_skate, foot_skate_ratio, jerk)

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
