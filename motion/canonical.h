#pragma once

#include "remomask/motion.h"

namespace remomask::motion {

struct CanonicalOptions {
  bool uniform_skeleton = true;  ///< give every clip the bone lengths of the skeleton
  bool floor = true;             ///< lowest joint over all frames to y = 0
  bool origin = true;            ///< root of frame 0 to x = z = 0
  bool facing = true;            ///< frame 0 faces +Z
};

/// Brings raw positions to canonical form, in the order of HumanML3D's processing. Throws Error if
/// a value is not finite or a leg has no length.
Motion canonicalize(const Motion& raw, const Skeleton& skeleton,
                    const CanonicalOptions& options = {});

/// Exchanges left and right (negates x, swaps the sides). Applied twice, it is the identity.
Motion mirror_motion(const Motion& motion, const Skeleton& skeleton);

/// Resamples positions linearly in time from `source_fps` to `target_fps`.
Motion resample(const Motion& motion, double source_fps, double target_fps);

}  // namespace remomask::motion
