#include "pipeline/physical.h"
#include "motion/vector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "pipeline/seams.h"
#include "remomask/error.h"

namespace remomask::pipeline {

namespace {

constexpr double kFloatingHeight = 0.10;  // m; a standing foot's joints are below it
constexpr double kContactHeight = 0.05;   // m; both limits as in the foot skating ratio
constexpr double kSkateSpeed = 0.5;  // m/s, of guided motion diffusion: 2.5 cm a frame at 20 fps

void measure_bones(const Motion& motion, const Skeleton& skeleton, PhysicalMetrics& metrics) {
  double sum = 0;
  int64_t bones = 0;
  for (int joint = 1; joint < motion.joints; ++joint) {
    const auto j = static_cast<size_t>(joint);
    const int parent = skeleton.parents[j];
    const auto length = [&](int frame) {
      return (joint_position(motion, frame, joint) - joint_position(motion, frame, parent)).norm();
    };
    const double wanted = skeleton.bone_lengths[j] > 0 ? skeleton.bone_lengths[j] : length(0);
    if (wanted <= 0) continue;
    for (int frame = 0; frame < motion.frames; ++frame) {
      const double deviation = std::abs(length(frame) - wanted) / wanted;
      sum += deviation;
      ++bones;
      metrics.bone_length_max = std::max(metrics.bone_length_max, deviation);
    }
  }
  if (bones > 0) metrics.bone_length_mean = sum / static_cast<double>(bones);
}

void measure_floor(const Motion& motion, const Skeleton& skeleton, PhysicalMetrics& metrics) {
  for (int frame = 0; frame < motion.frames; ++frame) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto* feet : {&skeleton.left_feet, &skeleton.right_feet}) {
      for (const int joint : *feet) {
        lowest = std::min(lowest, static_cast<double>(motion.at(frame, joint)[1]));
      }
    }
    const double depth = std::max(0.0, -lowest);
    if (lowest > kFloatingHeight) metrics.floating_share += 1.0 / motion.frames;
    metrics.penetration_mean += depth / motion.frames;
    metrics.penetration_max = std::max(metrics.penetration_max, depth);
  }
}

void measure_skate(const Motion& motion, const Skeleton& skeleton, PhysicalMetrics& metrics) {
  if (motion.frames < 2) return;
  int contacts = 0, slides = 0;
  double speeds = 0;
  // The toes only: an ankle turns around a standing toe.
  for (const int toe : {skeleton.left_feet.back(), skeleton.right_feet.back()}) {
    for (int frame = 0; frame + 1 < motion.frames; ++frame) {
      const Vec3 here = joint_position(motion, frame, toe),
                 next = joint_position(motion, frame + 1, toe);
      if (here.y() >= kContactHeight || next.y() >= kContactHeight) continue;
      const double speed = std::hypot(next.x() - here.x(), next.z() - here.z()) * skeleton.fps;
      ++contacts;
      speeds += speed;
      if (speed > kSkateSpeed) ++slides;
    }
  }
  metrics.contact_share = contacts / (2. * (motion.frames - 1));
  if (contacts == 0) return;
  metrics.foot_skate = speeds / contacts;
  metrics.foot_skate_ratio = static_cast<double>(slides) / contacts;
}

void measure_jerk(const Motion& motion, const Skeleton& skeleton, PhysicalMetrics& metrics) {
  const std::vector<double> jerk = jerk_over_time(motion, skeleton);
  if (jerk.empty()) return;
  metrics.jerk = std::accumulate(jerk.begin(), jerk.end(), 0.0) / static_cast<double>(jerk.size());
}

}  // namespace

PhysicalMetrics measure_physical(const Motion& motion, const Skeleton& skeleton) {
  if (motion.frames < 1 || motion.joints != skeleton.joints()) {
    throw Error(
        fmt::format("a motion of {} frames and {} joints does not fit the skeleton '{}' "
                    "of {} joints",
                    motion.frames, motion.joints, skeleton.name, skeleton.joints()));
  }
  PhysicalMetrics metrics;
  metrics.finite = std::all_of(motion.positions.begin(), motion.positions.end(),
                               [](float value) { return std::isfinite(value); });
  if (!metrics.finite) return metrics;
  measure_bones(motion, skeleton, metrics);
  measure_floor(motion, skeleton, metrics);
  measure_skate(motion, skeleton, metrics);
  measure_jerk(motion, skeleton, metrics);
  return metrics;
}

PhysicalSummary summarise_physical(const std::vector<PhysicalMetrics>& metrics) {
  PhysicalSummary summary;
  summary.motions = static_cast<int>(metrics.size());
  summary.not_finite = static_cast<int>(std::count_if(
      metrics.begin(), metrics.end(), [](const PhysicalMetrics& one) { return !one.finite; }));
  const double finite = summary.motions - summary.not_finite;
  PhysicalMetrics& values = summary.values;
  values.finite = summary.not_finite == 0;
  for (const PhysicalMetrics& one : metrics) {
    if (!one.finite) continue;
    values.bone_length_mean += one.bone_length_mean / finite;
    values.bone_length_max = std::max(values.bone_length_max, one.bone_length_max);
    values.penetration_mean += one.penetration_mean / finite;
    values.penetration_max = std::max(values.penetration_max, one.penetration_max);
    values.floating_share += one.floating_share / finite;
    values.contact_share += one.contact_share / finite;
    values.foot_skate += one.foot_skate / finite;
    values.foot_skate_ratio += one.foot_skate_ratio / finite;
    values.jerk += one.jerk / finite;
  }
  return summary;
}

}  // namespace remomask::pipeline
