#include "pipeline/seams.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace remomask::pipeline {

std::vector<double> jerk_over_time(const Motion& motion, const Skeleton& skeleton) {
  std::vector<double> curve;
  const double scale = std::pow(skeleton.fps, 3) / motion.joints;
  for (int frame = 0; frame + 3 < motion.frames; ++frame) {
    double sum = 0;
    for (int joint = 0; joint < motion.joints; ++joint) {
      sum +=
          (joint_position(motion, frame + 3, joint) - 3 * joint_position(motion, frame + 2, joint) +
           3 * joint_position(motion, frame + 1, joint) - joint_position(motion, frame, joint))
              .norm();
    }
    curve.push_back(sum * scale);
  }
  return curve;
}

double jerk_at_seam(const std::vector<double>& jerk, int seam, int reach) {
  const int count = static_cast<int>(jerk.size());
  const int begin = std::max(0, seam - reach - 3), end = std::min(count, seam + reach);
  if (begin >= end) return 0;
  return std::accumulate(jerk.begin() + begin, jerk.begin() + end, 0.0) / (end - begin);
}

double jerk_of_database(const db::Database& database, const Skeleton& skeleton, int most) {
  const std::vector<db::Clip> clips = database.clips();
  const size_t step = std::max<size_t>(1, clips.size() / static_cast<size_t>(most));
  double sum = 0;
  int count = 0;
  for (size_t i = 0; i < clips.size() && count < most; i += step) {
    if (clips[i].skeleton != skeleton.name || clips[i].frames < 4) continue;
    const std::vector<double> jerk = jerk_over_time(database.motion(clips[i].id), skeleton);
    sum += std::accumulate(jerk.begin(), jerk.end(), 0.0) / static_cast<double>(jerk.size());
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

std::vector<double> lowest_foot_over_time(const Motion& motion, const Skeleton& skeleton) {
  std::vector<double> heights;
  for (int frame = 0; frame < motion.frames; ++frame) {
    double lowest = joint_position(motion, frame, skeleton.left_feet.front()).y();
    for (const auto* feet : {&skeleton.left_feet, &skeleton.right_feet}) {
      for (const int joint : *feet)
        lowest = std::min(lowest, joint_position(motion, frame, joint).y());
    }
    heights.push_back(lowest);
  }
  return heights;
}

}  // namespace remomask::pipeline
