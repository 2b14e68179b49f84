#pragma once

#include <vector>

#include "remomask/motion.h"

namespace remomask::evaluation {

/// Motions one after the other as one: each is turned around +Y and moved on the
/// floor so that its root begins where the one before ended, facing the same
/// way. The step between the two poses fades over the first `fade` frames of the
/// later one (joint offsets, linear), so that no joint jumps. As many frames as
/// all together. Throws Error for no motions or one without frames.
Motion join_motions(const std::vector<Motion>& motions, const Skeleton& skeleton, int fade = 5);

}  // namespace remomask::evaluation
