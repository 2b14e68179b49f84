#include "motion/heading.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace remomask::motion {

namespace {

std::vector<double> half_gaussian(double sigma, int radius) {
  std::vector<double> weights(static_cast<size_t>(radius) + 1);
  double sum = 0;
  for (int i = 0; i <= radius; ++i) {
    weights[i] = std::exp(-0.5 * i * i / (sigma * sigma));
    sum += i == 0 ? weights[i] : 2 * weights[i];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

Headings official_headings(const Motion& motion, const Skeleton& skeleton) {
  const int n = motion.frames;
  std::vector<Vec3> facing(n);
  for (int t = 0; t < n; ++t) {
    const Vec3 across = across_body(motion, t, skeleton, true);
    const double length = across.norm();
    facing[t] = length > 0 ? Vec3::UnitY().cross(across / length) : Vec3(0, 0, 0);
  }
  constexpr int kRadius = 80;
  const std::vector<double> weights = half_gaussian(20, kRadius);
  Headings result;
  result.angles.resize(n);
  for (int t = 0; t < n; ++t) {
    Vec3 sum = weights[0] * facing[t];
    for (int i = 1; i <= kRadius; ++i) {
      sum += weights[i] * (facing[std::max(0, t - i)] + facing[std::min(n - 1, t + i)]);
    }
    result.angles[t] = std::atan2(sum.x(), sum.z());
  }
  if (n > 0) result.angles[0] = 0;
  return result;
}

Headings fixed_headings(const Motion& motion, const Skeleton& skeleton) {
  const int n = motion.frames;
  std::vector<double> raw(n), levelness(n);
  for (int t = 0; t < n; ++t) {
    const Vec3 across = across_body(motion, t, skeleton);
    const Vec3 facing = Vec3::UnitY().cross(across);
    raw[t] = std::atan2(facing.x(), facing.z());
    // An upright across axis (lying on the side, a cartwheel) says little about
    // the heading; the small constant keeps the weights positive.
    levelness[t] = facing.squaredNorm() / std::max(across.squaredNorm(), 1e-12) + 1e-3;
    if (t > 0) {
      raw[t] = raw[t - 1] + std::remainder(raw[t] - raw[t - 1], 2 * std::numbers::pi);
    }
  }
  constexpr int kRadius = 12;
  const std::vector<double> weights = half_gaussian(3, kRadius);
  Headings result;
  result.angles.resize(n);
  for (int t = 0; t < n; ++t) {
    double sum = 0, total = 0;
    for (int i = -kRadius; i <= kRadius; ++i) {
      const int at = std::clamp(t + i, 0, n - 1);
      const double weight = weights[std::abs(i)] * levelness[at];
      sum += weight * raw[at];
      total += weight;
    }
    result.angles[t] = sum / total;
  }
  result.initial = n > 0 ? result.angles[0] : 0;
  for (double& angle : result.angles) angle -= result.initial;
  return result;
}

}  // namespace

Vec3 across_body(const Motion& motion, int frame, const Skeleton& skeleton, bool historical_hips) {
  const Vec3 hips = joint_position(motion, frame, skeleton.right_hip) -
                    joint_position(motion, frame, skeleton.left_hip);
  const Vec3 shoulders = joint_position(motion, frame, skeleton.right_shoulder) -
                         joint_position(motion, frame, skeleton.left_shoulder);
  return historical_hips ? Vec3(shoulders - hips) : Vec3(shoulders + hips);
}

Headings find_headings(const Motion& motion, const Skeleton& skeleton, FeatureMode mode) {
  return mode == FeatureMode::official ? official_headings(motion, skeleton)
                                       : fixed_headings(motion, skeleton);
}

}  // namespace remomask::motion
