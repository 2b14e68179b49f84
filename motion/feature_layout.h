#pragma once

#include <cstdint>

#include "remomask/skeleton.h"

namespace remomask::motion {

/// First columns of the groups of a feature row (12 J - 1 columns, see
/// motion/features.h) for J joints.
struct FeatureLayout {
  int64_t joints, dim;
  int64_t yaw = 0, root_velocity = 1, height = 3, positions = 4;
  int64_t rotations, velocities, contacts;

  explicit FeatureLayout(const Skeleton& skeleton)
      : joints(skeleton.joints()),
        dim(skeleton.feature_dim()),
        rotations(positions + 3 * (joints - 1)),
        velocities(rotations + 6 * (joints - 1)),
        contacts(velocities + 3 * joints) {}
};

}  // namespace remomask::motion
