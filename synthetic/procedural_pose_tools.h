#pragma once

#include <vector>

#include "base/time.h"
#include "synthetic/procedural_gait.h"

namespace remomask::synthetic {

/// Poses of a relaxed stand, each changed by `shape(time, pose)`.
template <class Shape>
std::vector<BodyPose> make_poses(double duration, Shape&& shape) {
  std::vector<BodyPose> poses(static_cast<size_t>(frames_in(duration)), standing_pose());
  for (size_t f = 0; f < poses.size(); ++f) shape(seconds_of(f), poses[f]);
  return poses;
}

/// Which of `count` repetitions of `period` seconds from `start` is running.
struct Repetition {
  bool active = false;
  int index = 0;
  double phase = 0;  ///< 0 .. 1 within the repetition
};

inline Repetition repetition(double time, double start, double period, int count) {
  const double at = (time - start) / period;
  if (at < 0 || at >= count) return {};
  const int index = static_cast<int>(at);
  return {true, index, at - index};
}

}  // namespace remomask::synthetic
