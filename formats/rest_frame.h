#pragma once

#include "remomask/motion.h"

namespace remomask::formats {

/// How many frames at the start of a clip are no motion but the rest pose that a converter put in
/// front of it, with the few that blend out of it; usually 0. `rest_pose` is one frame. A clip
/// whose performer stands in a T-pose for a while keeps its start.
int count_rest_frames(const Motion& raw, const Motion& rest_pose, double fps);

}  // namespace remomask::formats
