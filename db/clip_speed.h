#pragma once

#include "remomask/motion.h"

namespace remomask::db {

/// Frame rate of every stored motion.
constexpr double kStoredFramesPerSecond = 20;

/// Whether there is at least one frame and one joint, with three numbers for each joint.
bool is_whole_motion(const Motion& motion);

/// Length of the root's path over the ground divided by its duration, m/s, at 20
/// frames per second; 0 for a single frame.
double mean_root_speed(const Motion& motion);

}  // namespace remomask::db
