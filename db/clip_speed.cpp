#include "db/clip_speed.h"

#include <cmath>

namespace remomask::db {

bool is_whole_motion(const Motion& motion) {
  return motion.frames >= 1 && motion.joints >= 1 &&
         motion.positions.size() == static_cast<size_t>(motion.frames) * motion.joints * 3;
}

double mean_root_speed(const Motion& motion) {
  if (motion.frames < 2) return 0;
  double path = 0;
  for (int frame = 1; frame < motion.frames; ++frame) {
    const float* before = motion.at(frame - 1, 0);
    const float* now = motion.at(frame, 0);
    path += std::hypot(now[0] - before[0], now[2] - before[2]);
  }
  return path * kStoredFramesPerSecond / (motion.frames - 1);
}

}  // namespace remomask::db
