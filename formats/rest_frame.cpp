#include "formats/rest_frame.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "motion/vector.h"

namespace remomask::formats {

namespace {

constexpr int kJointCount = 22;
constexpr int kLookedAt = 48;  // frames
// In heights of a body. A rest pose of another unit of angle or with toes bent differs a little.
constexpr double kSamePose = 0.03, kJump = 0.06;
constexpr double kFastestStart = 3;      // heights a second: nobody is that fast at once
constexpr double kBlendSeconds = 0.075;  // a converter's filter is a few frames long

using Pose = Eigen::Matrix<double, 3, kJointCount>;

/// A pose around its centre.
Pose centred_pose(const Motion& motion, int frame) {
  Pose pose;
  for (int j = 0; j < kJointCount; ++j) pose.col(j) = joint_position(motion, frame, j);
  const Vec3 centre = pose.rowwise().mean();
  return pose.colwise() - centre;
}

/// Largest distance of a joint when b is turned to fit a best (Kabsch).
double distance_of_poses(const Pose& a, const Pose& b) {
  const Eigen::Matrix3d covariance = a * b.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 signs(1, 1, 1);
  signs.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  const Eigen::Matrix3d turn = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  return (a - turn * b).colwise().norm().maxCoeff();
}

/// Arms stretched out to the sides and legs straight down: the rest pose of most rigs.
bool is_t_pose(const Pose& p) {
  constexpr int kHips[] = {1, 2}, kAnkles[] = {7, 8}, kKnees[] = {4, 5}, kNeck = 12;
  constexpr int kShoulders[] = {16, 17}, kElbows[] = {18, 19}, kWrists[] = {20, 21};
  const Vec3 up = (p.col(kNeck) - (p.col(1) + p.col(2)) / 2).normalized();
  const Vec3 left = (p.col(1) - p.col(2)).normalized();
  const auto along = [&](int a, int b, const Vec3& direction) {
    return (p.col(b) - p.col(a)).normalized().dot(direction);
  };
  constexpr double kStraight = 0.94;  // within 20 degrees
  for (int side = 0; side < 2; ++side) {
    const Vec3 outward = side == 0 ? left : Vec3(-left);
    if (along(kShoulders[side], kElbows[side], outward) < kStraight ||
        along(kElbows[side], kWrists[side], outward) < kStraight ||
        along(kHips[side], kKnees[side], up) > -kStraight ||
        along(kKnees[side], kAnkles[side], up) > -kStraight) {
      return false;
    }
  }
  return true;
}

}  // namespace

int count_rest_frames(const Motion& raw, const Motion& rest_pose, double fps) {
  const int looked_at = std::min(raw.frames, kLookedAt);
  if (looked_at < 3 || !(fps > 0)) return 0;
  const Pose rest = centred_pose(rest_pose, 0);
  std::vector<Pose> poses;
  for (int t = 0; t < looked_at; ++t) poses.push_back(centred_pose(raw, t));
  const double height = (poses[0].rowwise().maxCoeff() - poses[0].rowwise().minCoeff()).maxCoeff();
  if (!(height > 1e-9)) return 0;
  const auto step = [&](int t) {
    return distance_of_poses(poses[static_cast<size_t>(t)], poses[static_cast<size_t>(t) + 1]) /
           height;
  };
  const double first_step = step(0);
  if (first_step < kJump || first_step * fps < kFastestStart) return 0;
  if (distance_of_poses(rest, poses[0]) > kSamePose * height && !is_t_pose(poses[0])) return 0;
  // How fast the clip goes on. A single jump stands out against it; a blend is several jumps.
  std::vector<double> later;
  const int blended = static_cast<int>(kBlendSeconds * fps);
  for (int t = 1 + blended; t + 1 < looked_at; ++t) later.push_back(step(t));
  double usual = 0;
  if (!later.empty()) {
    std::nth_element(later.begin(), later.begin() + static_cast<long>(later.size() / 2),
                     later.end());
    usual = later[later.size() / 2];
  }
  if (first_step < 4 * usual) return 0;
  int frames = 1;
  while (frames <= blended && frames + 2 < raw.frames && frames + 1 < looked_at &&
         step(frames) > std::max(0.02, 3 * usual)) {
    ++frames;
  }
  return frames;
}

}  // namespace remomask::formats
