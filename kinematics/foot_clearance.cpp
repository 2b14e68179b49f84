#include "kinematics/foot_clearance.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>

#include "kinematics/leg.h"
#include "motion/part_mask.h"

namespace remomask::kinematics {

namespace {

/// m/s over the ground between frames t and t + 1.
double ground_speed(const Motion& motion, int t, int joint, double fps) {
  const Vec3 step = joint_position(motion, t + 1, joint) - joint_position(motion, t, joint);
  return std::hypot(step.x(), step.z()) * fps;
}

/// Speed of the body around every frame: the mean over one second.
std::vector<double> body_speed(const Motion& motion, double fps) {
  const int steps = motion.frames - 1, reach = static_cast<int>(fps / 2);
  std::vector<double> speed(static_cast<size_t>(motion.frames));
  for (int t = 0; t < motion.frames; ++t) {
    const int first = std::max(0, t - reach), last = std::min(steps, t + reach + 1);
    for (int i = first; i < last; ++i) {
      speed[static_cast<size_t>(t)] += ground_speed(motion, i, 0, fps) / (last - first);
    }
  }
  return speed;
}

/// Stretches of frames at which a fast step of the toe begins or ends.
std::vector<motion::FrameRun> swings_of(const Motion& motion, int toe, double fps,
                                        double min_speed) {
  std::vector<motion::FrameRun> swings;
  for (int t = 0; t + 1 < motion.frames; ++t) {
    if (ground_speed(motion, t, toe, fps) <= min_speed) continue;
    if (swings.empty() || swings.back().last <= t) swings.push_back({t, t});
    swings.back().last = t + 2;
  }
  return swings;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// How far the swing is to be raised.
double missing_height(const Motion& motion, const motion::FrameRun& swing, int toe,
                      const std::vector<double>& body, const FootClearanceOptions& options) {
  std::vector<double> heights;
  double speed = 0;
  for (int t = swing.first; t < swing.last; ++t) {
    heights.push_back(joint_position(motion, t, toe).y());
    speed += body[static_cast<size_t>(t)] / (swing.last - swing.first);
  }
  return std::clamp(options.height * speed - median(heights), 0.0, options.max_raise);
}

/// 0 just outside the swing, 1 from `fade` frames inside it on. Nothing fades at the ends of the
/// motion.
double swing_weight(const Motion& motion, const motion::FrameRun& swing, int t, int fade) {
  int distance = fade;
  if (swing.first > 0) distance = std::min(distance, t - swing.first);
  if (swing.last < motion.frames) distance = std::min(distance, swing.last - 1 - t);
  const double u = (distance + 1.0) / (fade + 1);
  return u * u * (3 - 2 * u);
}

}  // namespace

void raise_swings(Motion& motion, const Skeleton& skeleton, const FootClearanceOptions& options) {
  if (motion.frames < 2) return;
  const std::vector<double> body = body_speed(motion, skeleton.fps);
  for (const auto* feet : {&skeleton.left_feet, &skeleton.right_feet}) {
    const int toe = feet->back();
    for (const motion::FrameRun& swing :
         swings_of(motion, toe, skeleton.fps, options.swing_speed)) {
      const double height = missing_height(motion, swing, toe, body, options);
      if (height < 1e-6) continue;
      const Leg leg = leg_of(*feet, skeleton, motion, swing.first);
      for (int t = swing.first; t < swing.last; ++t) {
        const double weight = swing_weight(motion, swing, t, options.fade);
        if (weight > 0) move_foot(motion, t, leg, Vec3(0, weight * height, 0));
      }
    }
  }
}

}  // namespace remomask::kinematics
