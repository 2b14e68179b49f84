#include "rig/rest_skeleton.h"

#include <algorithm>
#include <cmath>

#include "kinematics/pose_fit.h"

namespace remomask::rig {

namespace {

constexpr size_t kToes[] = {10, 11};

/// Directions of the bones in the T-pose, each from the parent. The lengths come from elsewhere.
const Pose& natural_directions() {
  static const Pose directions = [] {
    Pose d = {Vec3(0, 0, 0),          Vec3(0.064, -0.078, 0.01), Vec3(-0.064, -0.078, 0.01),
              Vec3(0, 0.131, -0.012), Vec3(0.01, -0.38, 0),      Vec3(-0.01, -0.38, 0),
              Vec3(0, 0.135, 0),      Vec3(0, -0.4, -0.03),      Vec3(0, -0.4, -0.03),
              Vec3(0, 0.053, 0.015),  Vec3(0, -0.055, 0.12),     Vec3(0, -0.055, 0.12),
              Vec3(0, 0.216, -0.036), Vec3(0.062, 0.12, -0.025), Vec3(-0.062, 0.12, -0.025),
              Vec3(0, 0.08, 0.04),    Vec3(0.1, 0.03, -0.01),    Vec3(-0.1, 0.03, -0.01),
              Vec3(0.26, 0, 0),       Vec3(-0.26, 0, 0),         Vec3(0.25, 0, 0),
              Vec3(-0.25, 0, 0)};
    for (Vec3& direction : d) {
      if (direction.squaredNorm() > 0) direction.normalize();
    }
    return d;
  }();
  return directions;
}

/// Puts the pelvis so high that the lower toe joint is on the ground, and adds the tips.
void finish(RestSkeleton& rest) {
  const std::vector<int>& parents = humanml_skeleton().parents;
  double lowest = 0;
  for (const size_t toe : kToes) {
    double height = 0;
    for (int j = static_cast<int>(toe); j > 0; j = parents[static_cast<size_t>(j)]) {
      height += rest.offsets[static_cast<size_t>(j)].y();
    }
    lowest = std::min(lowest, height);
  }
  rest.offsets[0] = Vec3(0, -lowest, 0);
  rest.tips.fill(Vec3::Zero());
  rest.tips[10] = rest.tips[11] = Vec3(0, 0, 0.06);
  rest.tips[15] = Vec3(0, 0.18, 0);
  rest.tips[20] = Vec3(0.09, 0, 0);
  rest.tips[21] = Vec3(-0.09, 0, 0);
}

Quat triangle_axes(const Vec3& left, const Vec3& right, const Vec3& top) {
  Vec3 across = left - right;
  if (across.squaredNorm() < 1e-18) across = Vec3::UnitX();
  across.normalize();
  Vec3 up = top - 0.5 * (left + right);
  up -= across * across.dot(up);
  if (up.squaredNorm() < 1e-18) up = across.unitOrthogonal();
  up.normalize();
  Eigen::Matrix3d axes;
  axes << across, up, across.cross(up);
  return Quat(axes);
}

/// The mean shape of the bones to three children, turned into the T-pose: alternates rotations
/// and means.
void take_mean_shape(const Motion& motion, int joint, const std::array<int, 3>& children,
                     RestSkeleton& rest) {
  constexpr int kRounds = 4;
  const auto bone = [&](int frame, size_t i) -> Vec3 {
    return joint_position(motion, frame, children[i]) - joint_position(motion, frame, joint);
  };
  // The children are the left one, the right one, and the upper one.
  std::array<Vec3, 3> shape;
  for (size_t i = 0; i < 3; ++i) shape[i] = natural_directions()[static_cast<size_t>(children[i])];
  for (int round = 0; round < kRounds; ++round) {
    std::array<Vec3, 3> sum = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    for (int t = 0; t < motion.frames; ++t) {
      const Quat back =
          rotation_of_triangle(shape[0], shape[1], shape[2], bone(t, 0), bone(t, 1), bone(t, 2))
              .conjugate();
      for (size_t i = 0; i < 3; ++i) sum[i] += back * bone(t, i);
    }
    for (size_t i = 0; i < 3; ++i) shape[i] = sum[i] / motion.frames;
  }
  for (size_t i = 0; i < 3; ++i) rest.offsets[static_cast<size_t>(children[i])] = shape[i];
}

}  // namespace

Quat rotation_of_triangle(const Vec3& left, const Vec3& right, const Vec3& top, const Vec3& to_left,
                          const Vec3& to_right, const Vec3& to_top) {
  return triangle_axes(to_left, to_right, to_top) * triangle_axes(left, right, top).conjugate();
}

const RestSkeleton& human_rest() {
  static const RestSkeleton rest = [] {
    RestSkeleton result;
    for (size_t j = 0; j < kRigJoints; ++j) {
      result.offsets[j] = natural_directions()[j] * humanml_skeleton().bone_lengths[j];
    }
    finish(result);
    return result;
  }();
  return rest;
}

RestSkeleton performer_rest(const Motion& motion) {
  RestSkeleton rest;
  const std::vector<double> lengths = kinematics::mean_bone_lengths(motion, humanml_skeleton());
  for (size_t j = 0; j < kRigJoints; ++j) rest.offsets[j] = natural_directions()[j] * lengths[j];
  take_mean_shape(motion, 0, {1, 2, 3}, rest);
  take_mean_shape(motion, 9, {13, 14, 12}, rest);
  finish(rest);
  return rest;
}

}  // namespace remomask::rig
