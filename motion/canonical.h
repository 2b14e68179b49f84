#pragma once

#include "remomask/motion.h"

namespace remomask::motion {

struct CanonicalOptions {
  bool uniform_skeleton = true;  ///< give every clip the bone lengths of the skeleton
  bool floor = true;             ///< lowest joint over all frames to y = 0
  bool origin = true;            ///< root of frame 0 to x = z = 0
  bool facing = true;            ///< frame 0 faces +Z
};

/// Raw positions -> canonical positions, in the order of HumanML3D. Throws
/// Error when a value is not finite or a leg has no length.
Motion canonicalize(const Motion& raw, const Skeleton& skeleton,
                    const CanonicalOptions& options = {});

/// Left and right exchanged (x negated, sides swapped). Twice is the identity.
Motion mirror_motion(const Motion& motion, const Skeleton& skeleton);

/// Linear resampling in time (positions) from `source_fps` to `target_fps`.
Motion resample(const Motion& motion, double source_fps, double target_fps);

}  // namespace remomask::motion
