#pragma once

#include "remomask/motion.h"

namespace remomask::db {

/// Frames a second of every stored motion.
constexpr double kStoredFramesPerSecond = 20;

/// True when there is a frame, a joint, and three numbers for each of them.
bool is_whole_motion(const Motion& motion);

/// Length of the root's path over the ground divided by its time, m/s, at 20
/// frames a second; 0 for a single frame.
double mean_root_speed(const Motion& motion);

}  // namespace remomask::db
