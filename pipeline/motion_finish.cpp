#include "pipeline/motion_finish.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "kinematics/foot_anchor.h"
#include "kinematics/foot_clearance.h"
#include "kinematics/foot_lock.h"

namespace remomask::pipeline {

void impose_bone_lengths(Motion& motion, const Skeleton& skeleton) {
  std::vector<Vec3> before(static_cast<size_t>(motion.joints));
  for (int frame = 0; frame < motion.frames; ++frame) {
    for (int joint = 0; joint < motion.joints; ++joint) {
      before[static_cast<size_t>(joint)] = joint_position(motion, frame, joint);
    }
    for (int joint = 0; joint < motion.joints; ++joint) {
      const int parent = skeleton.parents[static_cast<size_t>(joint)];
      if (parent < 0) continue;
      Vec3 direction = before[static_cast<size_t>(joint)] - before[static_cast<size_t>(parent)];
      if (direction.norm() < 1e-6) {
        direction = rest_direction(skeleton, static_cast<size_t>(joint));
      }
      set_joint_position(
          motion, frame, joint,
          joint_position(motion, frame, parent) +
              skeleton.bone_lengths[static_cast<size_t>(joint)] * direction.normalized());
    }
  }
}

void smooth_over_time(Motion& motion, double sigma) {
  if (sigma <= 0 || motion.frames < 2) return;
  const int radius = static_cast<int>(std::ceil(3 * sigma)), last = motion.frames - 1;
  std::vector<double> weights;
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(std::exp(-i * i / (2 * sigma * sigma)));
    sum += weights.back();
  }
  const Motion before = motion;
  const auto at = [&](int t, int joint) -> Vec3 {
    if (t < 0)
      return 2 * joint_position(before, 0, joint) -
             joint_position(before, std::min(-t, last), joint);
    if (t <= last) return joint_position(before, t, joint);
    return 2 * joint_position(before, last, joint) -
           joint_position(before, std::max(0, 2 * last - t), joint);
  };
  for (int t = 0; t <= last; ++t) {
    for (int joint = 0; joint < motion.joints; ++joint) {
      Vec3 mean = Vec3::Zero();
      for (int i = -radius; i <= radius; ++i) {
        mean += weights[static_cast<size_t>(i + radius)] / sum * at(t + i, joint);
      }
      set_joint_position(motion, t, joint, mean);
    }
  }
}

namespace {

double lowest_foot(const Motion& motion, int frame, const Skeleton& skeleton) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto* feet : {&skeleton.left_feet, &skeleton.right_feet}) {
    for (const int joint : *feet)
      lowest = std::min(lowest, joint_position(motion, frame, joint).y());
  }
  return lowest;
}

void raise_frame(Motion& motion, int frame, double height) {
  for (int joint = 0; joint < motion.joints; ++joint) {
    motion.at(frame, joint)[1] += static_cast<float>(height);
  }
}

}  // namespace

// m/s. Feet of generated runs slide faster than those of real ones swing this low: with
// 0.5 they slide 1.6 times as fast as real feet (on val), with 2 as fast as those.
constexpr double kSlidingSpeed = 2;

void hold_feet(Motion& motion, const motion::Features& features, const Skeleton& skeleton) {
  kinematics::anchor_to_feet(motion, kinematics::read_contacts(features, skeleton), skeleton);
  motion::PartMask all(motion.frames);
  all.add(0, motion.frames);
  kinematics::FootLockOptions lock;
  lock.speed = kSlidingSpeed;
  kinematics::lock_feet(motion, Motion(motion), /*floor=*/0, all, skeleton, lock);
  kinematics::raise_swings(motion, skeleton);
}

double lift_to_floor(Motion& motion, const Skeleton& skeleton, double tolerance) {
  double lowest = 0;
  for (int frame = 0; frame < motion.frames; ++frame) {
    lowest = std::min(lowest, lowest_foot(motion, frame, skeleton));
  }
  if (lowest >= -tolerance) return 0;
  for (int frame = 0; frame < motion.frames; ++frame) raise_frame(motion, frame, -lowest);
  return -lowest;
}

double lift_to_floor_smoothly(Motion& motion, const Skeleton& skeleton, int reach) {
  const int frames = motion.frames;
  std::vector<double> depth(static_cast<size_t>(frames)), deepest(depth.size());
  for (int t = 0; t < frames; ++t) {
    depth[static_cast<size_t>(t)] = std::max(0.0, -lowest_foot(motion, t, skeleton));
  }
  const auto around = [&](const std::vector<double>& values, int t) {
    return std::pair(values.begin() + std::max(0, t - reach),
                     values.begin() + std::min(frames, t + reach + 1));
  };
  for (int t = 0; t < frames; ++t) {
    const auto [begin, end] = around(depth, t);
    deepest[static_cast<size_t>(t)] = *std::max_element(begin, end);
  }
  // The mean of such maxima is nowhere less than the depth itself.
  double largest = 0;
  for (int t = 0; t < frames; ++t) {
    const auto [begin, end] = around(deepest, t);
    const double raise = std::accumulate(begin, end, 0.0) / static_cast<double>(end - begin);
    if (raise > 0) raise_frame(motion, t, raise);
    largest = std::max(largest, raise);
  }
  return largest;
}

}  // namespace remomask::pipeline
