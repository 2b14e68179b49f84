#include "formats/axis_detection.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>

#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr int kHead = 15, kLeftAnkle = 7, kRightAnkle = 8;

/// Mean direction from between the ankles to the head.
Vec3 long_axis(const Motion& motion) {
  Vec3 sum = Vec3::Zero();
  const int step = std::max(1, motion.frames / 400);
  int count = 0;
  for (int t = 0; t < motion.frames; t += step, ++count) {
    const Vec3 ankles =
        (joint_position(motion, t, kLeftAnkle) + joint_position(motion, t, kRightAnkle)) / 2;
    sum += (joint_position(motion, t, kHead) - ankles).normalized();
  }
  return count > 0 ? Vec3(sum / count) : sum;
}

}  // namespace

char detect_up_axis(const Motion& raw, const Motion* rest_pose) {
  const Vec3 clip = long_axis(raw);
  Vec3 score = clip + Vec3(0, 0.4, 0);
  if (rest_pose) {
    // Only the axis counts, not its slant: rest poses lean as their bones do.
    int along = 0;
    long_axis(*rest_pose).maxCoeff(&along);
    score[along] += 0.9;
  }
  int best = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (score[axis] > score[best]) best = axis;
  }
  return static_cast<char>('X' + best);
}

double detect_metres_per_unit(const Motion& raw) {
  const auto bone = [&](int a, int b) {
    return (joint_position(raw, 0, a) - joint_position(raw, 0, b)).norm();
  };
  const double leg = (bone(1, 4) + bone(4, 7) + bone(2, 5) + bone(5, 8)) / 2;
  if (!(leg > 1e-9)) {
    throw Error("the legs have no length in the first frame; check the skeleton map");
  }
  // Metre, centimetre, millimetre, CMU's unit, inch, decimetre, FAIR's unit.
  constexpr double kUnits[] = {1, 0.01, 0.001, 0.056444, 0.0254, 0.1, 0.039};
  constexpr double kTypicalLeg = 0.83;
  double best = kTypicalLeg / leg, best_error = std::log(1.35);
  for (const double unit : kUnits) {
    const double error = std::abs(std::log(leg * unit / kTypicalLeg));
    if (error < best_error) {
      best_error = error;
      best = unit;
    }
  }
  return best;
}

void turn_up_axis(Motion& motion, char up_axis) {
  if (up_axis == 'Y') return;
  for (size_t i = 0; i < motion.positions.size(); i += 3) {
    float* p = &motion.positions[i];
    const float x = p[0], y = p[1], z = p[2];
    if (up_axis == 'Z') {
      p[1] = z;
      p[2] = -y;
    } else {
      p[0] = -y;
      p[1] = x;
    }
  }
}

}  // namespace remomask::formats
