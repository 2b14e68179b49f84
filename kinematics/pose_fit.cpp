#include "kinematics/pose_fit.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>

namespace remomask::kinematics {

namespace {

constexpr int kFitSteps = 8, kFitIterations = 20;
constexpr double kFitTolerance = 1e-7;  // m

struct Bone {
  int a, b;  // joints
  double length;
};

/// The joints that carry a fixed one, and the bones that tie them.
struct TiedJoints {
  std::vector<int> joints;
  std::vector<Bone> bones;
};

TiedJoints find_tied(const std::vector<bool>& free, const std::vector<double>& lengths,
                     const Skeleton& skeleton) {
  const int count = skeleton.joints();
  std::vector<bool> tied(count, false);
  for (int j = count - 1; j > 0; --j) {
    const int parent = skeleton.parents[j];
    if (free[parent] && (!free[j] || tied[j])) tied[parent] = true;
  }
  TiedJoints result;
  for (int j = 0; j < count; ++j) {
    if (tied[j]) result.joints.push_back(j);
    const int parent = skeleton.parents[j];
    const bool stands = j > 0 && (!free[j] || tied[j]) && (!free[parent] || tied[parent]);
    if (stands && (tied[j] || tied[parent])) result.bones.push_back({parent, j, lengths[j]});
  }
  return result;
}

/// Moves the tied joints by the shortest way onto the length constraints.
bool satisfy_lengths(const TiedJoints& tied, std::vector<Vec3>& pose) {
  const auto rows = static_cast<Eigen::Index>(tied.bones.size());
  const auto columns = static_cast<Eigen::Index>(tied.joints.size() * 3);
  std::vector<Eigen::Index> column(pose.size(), -1);
  for (size_t i = 0; i < tied.joints.size(); ++i) {
    column[tied.joints[i]] = static_cast<Eigen::Index>(3 * i);
  }
  for (int iteration = 0; iteration < kFitIterations; ++iteration) {
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows, columns);
    Eigen::VectorXd error(rows);
    for (Eigen::Index r = 0; r < rows; ++r) {
      const Bone& bone = tied.bones[static_cast<size_t>(r)];
      const Vec3 along = pose[bone.b] - pose[bone.a];
      const double length = along.norm();
      error[r] = length - bone.length;
      if (length < 1e-9) return false;
      const Vec3 direction = along / length;
      if (column[bone.b] >= 0) jacobian.block<1, 3>(r, column[bone.b]) = direction.transpose();
      if (column[bone.a] >= 0) jacobian.block<1, 3>(r, column[bone.a]) = -direction.transpose();
    }
    if (error.cwiseAbs().maxCoeff() < kFitTolerance) return true;
    const Eigen::VectorXd step = jacobian.completeOrthogonalDecomposition().solve(error);
    if (!step.allFinite()) return false;
    for (const int j : tied.joints) pose[j] -= step.segment<3>(column[j]);
  }
  return false;
}

}  // namespace

std::vector<double> mean_bone_lengths(const Motion& motion, const Skeleton& skeleton) {
  std::vector<double> lengths(skeleton.joints(), 0);
  for (int j = 1; j < skeleton.joints(); ++j) {
    for (int t = 0; t < motion.frames; ++t) {
      lengths[j] +=
          (joint_position(motion, t, j) - joint_position(motion, t, skeleton.parents[j])).norm();
    }
    lengths[j] /= std::max(1, motion.frames);
  }
  return lengths;
}

void fit_free_joints(std::vector<Vec3>& pose, const std::vector<Vec3>& target,
                     const std::vector<bool>& free, const std::vector<double>& lengths,
                     const Skeleton& skeleton) {
  const TiedJoints tied = find_tied(free, lengths, skeleton);
  std::vector<bool> placed(free.size(), false);
  for (const int j : tied.joints) placed[j] = true;
  for (int step = 0; step < kFitSteps && !tied.joints.empty(); ++step) {
    std::vector<Vec3> next = pose;
    for (const int j : tied.joints) next[j] += (target[j] - pose[j]) / (kFitSteps - step);
    if (!satisfy_lengths(tied, next)) break;
    pose = next;
  }
  for (int j = 0; j < skeleton.joints(); ++j) {
    if (!free[j] || placed[j]) continue;
    const int parent = skeleton.parents[j];
    if (parent < 0) {
      pose[j] = target[j];
      continue;
    }
    Vec3 direction = target[j] - target[parent];
    if (direction.norm() < 1e-9) direction = rest_direction(skeleton, j);
    pose[j] = pose[parent] + lengths[j] * direction.normalized();
  }
}

Vec3 bend_joint(const Vec3& root, Vec3& end, const Vec3& hint, double upper, double lower) {
  Vec3 along = end - root;
  double distance = along.norm();
  if (distance < 1e-9) {
    along = -Vec3::UnitY();
    distance = 1;
  }
  along /= distance;
  // A straight leg could bend to either side in the next frame.
  const double reach =
      std::clamp((end - root).norm(), std::abs(upper - lower) + 1e-3, (upper + lower) * 0.9995);
  end = root + reach * along;
  Vec3 side = hint - root - along * along.dot(hint - root);
  if (side.norm() < 1e-6) side = along.unitOrthogonal();
  side.normalize();
  const double forward = (upper * upper - lower * lower + reach * reach) / (2 * reach);
  const double out = std::sqrt(std::max(0.0, upper * upper - forward * forward));
  return root + forward * along + out * side;
}

}  // namespace remomask::kinematics
