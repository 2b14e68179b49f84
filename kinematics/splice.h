#pragma once

#include "motion/part_mask.h"
#include "remomask/motion.h"

namespace remomask::kinematics {

struct SpliceOptions {
  /// Frames inside the mask, at each of its edges, over which the difference in pose and velocity
  /// to the frames that stay fades out (cubic Hermite); at most half of the stretch.
  int fade = 6;
};

/// How far the new motion was bent to meet both ends; 0 where it had to meet only one.
struct SpliceReport {
  double path_shift = 0;  ///< m, the largest of all stretches
  double path_turn = 0;   ///< radians
};

/// Puts the marked cells of `made` into `original`. Both show the joints of
/// `skeleton` at its rate; `made` has the frames of `mask` and the bone lengths of the
/// skeleton, its floor at y = 0; `original` may stand anywhere, be of another
/// size, and be shorter: frames that it lacks must be marked whole. Positions
/// outside of the mask are those of `original` bit for bit. Inside:
/// - bones have the mean lengths of the original, and its floor;
/// - where all parts are marked, the path continues from the pose before the stretch
///   (place, heading), ends in the pose behind it, or does both: path and heading
///   are then bent along the way, where the new motion moves;
/// - where some parts stay, the new parts hang on them;
/// - planted feet are held, see lock_feet().
/// Throws Error when sizes do not fit.
Motion splice_motion(const Motion& original, const Motion& made, const motion::PartMask& mask,
                     const Skeleton& skeleton, const SpliceOptions& options = {},
                     SpliceReport* report = nullptr);

}  // namespace remomask::kinematics
