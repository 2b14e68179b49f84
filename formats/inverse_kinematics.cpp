#include "formats/inverse_kinematics.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>

#include "motion/rotation.h"
#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr double kRigidMetres = 0.0005;
constexpr int kIkPelvis = 0, kIkSpine1 = 3, kIkSpine2 = 6, kIkSpine3 = 9;

/// T-pose offsets in the proportions of the human body, metres. Only the directions matter; the
/// lengths come from the motion.
const std::vector<Vec3>& natural_offsets() {
  static const std::vector<Vec3> offsets = {
      {0, 0, 0},          {0.07, -0.09, 0},    {-0.07, -0.09, 0},    {0, 0.11, -0.025},
      {0.01, -0.38, 0},   {-0.01, -0.38, 0},   {0, 0.135, 0},        {0, -0.4, -0.03},
      {0, -0.4, -0.03},   {0, 0.053, 0.015},   {0, -0.055, 0.12},    {0, -0.055, 0.12},
      {0, 0.21, -0.03},   {0.08, 0.12, -0.03}, {-0.08, 0.12, -0.03}, {0, 0.08, 0.04},
      {0.1, 0.03, -0.01}, {-0.1, 0.03, -0.01}, {0.26, 0, 0},         {-0.26, 0, 0},
      {0.25, 0, 0},       {-0.25, 0, 0}};
  return offsets;
}

std::vector<std::vector<int>> children_of(const Skeleton& skeleton) {
  std::vector<std::vector<int>> children(skeleton.joints());
  for (int j = 1; j < skeleton.joints(); ++j) children[skeleton.parents[j]].push_back(j);
  return children;
}

/// Rotation R that minimises sum |to_i - R from_i|^2 (Kabsch 1976, by SVD).
Quat best_rotation(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < from.size(); ++i) covariance += to[i] * from[i].transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d turn = svd.matrixU() * svd.matrixV().transpose();
  if (turn.determinant() < 0) {
    Eigen::Matrix3d u = svd.matrixU();
    u.col(2) *= -1;
    turn = u * svd.matrixV().transpose();
  }
  return Quat(turn).normalized();
}

std::vector<Vec3> bones_from(const Motion& motion, int frame, int joint,
                             const std::vector<int>& children) {
  std::vector<Vec3> bones;
  for (const int child : children) {
    bones.push_back(joint_position(motion, frame, child) - joint_position(motion, frame, joint));
  }
  return bones;
}

/// The rigid shape that the bones to several children keep over the clip,
/// turned into the T-pose: alternates best rotations and mean shape.
std::vector<Vec3> rigid_shape(const Motion& motion, int joint, const std::vector<int>& children) {
  std::vector<Vec3> natural;
  for (const int child : children) natural.push_back(natural_offsets()[child]);
  std::vector<Vec3> shape = bones_from(motion, 0, joint, children);
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Vec3> sum(children.size(), Vec3::Zero());
    for (int t = 0; t < motion.frames; ++t) {
      const std::vector<Vec3> bones = bones_from(motion, t, joint, children);
      const Quat back = best_rotation(shape, bones).conjugate();
      for (size_t i = 0; i < sum.size(); ++i) sum[i] += back * bones[i];
    }
    for (size_t i = 0; i < sum.size(); ++i) shape[i] = sum[i] / motion.frames;
  }
  const Quat to_t_pose = best_rotation(shape, natural);
  for (Vec3& bone : shape) bone = to_t_pose * bone;
  return shape;
}

double mean_length(const Motion& motion, int joint, int parent) {
  double sum = 0;
  for (int t = 0; t < motion.frames; ++t) {
    sum += (joint_position(motion, t, joint) - joint_position(motion, t, parent)).norm();
  }
  return sum / motion.frames;
}

std::vector<Vec3> fit_rest_offsets(const Motion& motion, const Skeleton& skeleton,
                                   const std::vector<std::vector<int>>& children) {
  std::vector<Vec3> offsets(skeleton.joints(), Vec3::Zero());
  for (int j = 0; j < skeleton.joints(); ++j) {
    if (children[j].size() == 1) {
      const int child = children[j][0];
      offsets[child] = natural_offsets()[child].normalized() * mean_length(motion, child, j);
    } else if (children[j].size() > 1) {
      const std::vector<Vec3> shape = rigid_shape(motion, j, children[j]);
      for (size_t i = 0; i < shape.size(); ++i) offsets[children[j][i]] = shape[i];
    }
  }
  return offsets;
}

/// Turns the spine bones about themselves, by a third and two thirds of the
/// twist between pelvis and spine3; no joint moves.
void spread_spine_twist(const std::vector<Vec3>& rest, Quat* world) {
  const Quat relative = world[kIkSpine2].conjugate() * world[kIkSpine3];
  const Vec3 axis = rest[kIkSpine3].normalized();
  double w = relative.w(), along = relative.vec().dot(axis);
  if (w < 0) {
    w = -w;
    along = -along;
  }
  const double twist = 2 * std::atan2(along, w);
  world[kIkSpine1] =
      world[kIkSpine1] * Quat(Eigen::AngleAxisd(twist / 3, rest[kIkSpine2].normalized()));
  world[kIkSpine2] = world[kIkSpine2] * Quat(Eigen::AngleAxisd(twist * 2 / 3, axis));
}

/// Children of joints with several children.
std::vector<bool> free_joints(const std::vector<std::vector<int>>& children) {
  std::vector<bool> result(children.size(), false);
  for (const std::vector<int>& siblings : children) {
    if (siblings.size() < 2) continue;
    for (const int j : siblings) result[j] = true;
  }
  return result;
}

/// World rotations of one frame.
std::vector<Quat> solve_frame(const Motion& motion, int frame, const std::vector<Vec3>& rest,
                              const std::vector<std::vector<int>>& children,
                              const std::vector<bool>& free) {
  const Skeleton& skeleton = humanml_skeleton();
  std::vector<Vec3> reached(children.size());
  std::vector<Quat> world(children.size());
  for (size_t j = 0; j < children.size(); ++j) {
    const int parent = skeleton.parents[j];
    const Quat carried = parent >= 0 ? world[parent] : Quat::Identity();
    reached[j] = parent < 0 || free[j] ? joint_position(motion, frame, static_cast<int>(j))
                                       : Vec3(reached[parent] + carried * rest[j]);
    if (children[j].size() == 1) {
      // Aiming from where the joint actually is keeps a stretching bone from shifting the rest of
      // the limb.
      const int child = children[j][0];
      const Vec3 target = joint_position(motion, frame, child) - reached[j];
      world[j] = motion::shortest_arc(carried * rest[child], target) * carried;
    } else if (children[j].size() > 1) {
      std::vector<Vec3> bones;
      for (const int child : children[j]) bones.push_back(rest[child]);
      const int joint = static_cast<int>(j);
      world[j] = best_rotation(bones, bones_from(motion, frame, joint, children[j]));
    } else {
      world[j] = carried;
    }
  }
  spread_spine_twist(rest, world.data());
  return world;
}

const std::vector<int>& bvh_order() {
  static const std::vector<int> order = {0, 1,  4,  7,  10, 2,  5,  8,  11, 3,  6,
                                         9, 12, 15, 13, 16, 18, 20, 14, 17, 19, 21};
  return order;
}

const std::vector<std::string>& bvh_names() {
  static const std::vector<std::string> names = {
      "Hips",        "LeftUpLeg",    "RightUpLeg",    "Spine",    "LeftLeg", "RightLeg",
      "Spine1",      "LeftFoot",     "RightFoot",     "Spine2",   "LeftToe", "RightToe",
      "Neck",        "LeftShoulder", "RightShoulder", "Head",     "LeftArm", "RightArm",
      "LeftForeArm", "RightForeArm", "LeftHand",      "RightHand"};
  return names;
}

Vec3 end_site_offset(int joint) {
  switch (joint) {
    case 10:
    case 11:
      return {0, 0, 6};
    case 15:
      return {0, 18, 0};
    case 20:
      return {9, 0, 0};
    default:
      return {-9, 0, 0};
  }
}

/// Angles z, y, x of R = Rz Ry Rx in radians.
Vec3 euler_zyx(const Quat& q) {
  const Eigen::Matrix3d m = q.toRotationMatrix();
  const double y = std::asin(std::clamp(-m(2, 0), -1.0, 1.0));
  return {std::atan2(m(1, 0), m(0, 0)), y, std::atan2(m(2, 1), m(2, 2))};
}

Vec3 nearest_turns(Vec3 angles, const Vec3& before) {
  for (int i = 0; i < 3; ++i) {
    angles[i] = before[i] + std::remainder(angles[i] - before[i], 2 * M_PI);
  }
  return angles;
}

/// The same rotation by the angles closest to those of the previous frame.
Vec3 unwrapped(const Vec3& angles, const Vec3& before) {
  const Vec3 first = nearest_turns(angles, before);
  const Vec3 other(angles[0] + M_PI, M_PI - angles[1], angles[2] + M_PI);
  const Vec3 second = nearest_turns(other, before);
  return (first - before).squaredNorm() <= (second - before).squaredNorm() ? first : second;
}

}  // namespace

Pose22 solve_pose(const Motion& motion) {
  const Skeleton& skeleton = humanml_skeleton();
  if (motion.joints != skeleton.joints() || motion.frames < 1) {
    throw Error("bone rotations need a motion of 22 joints with at least one frame");
  }
  for (const float value : motion.positions) {
    if (!std::isfinite(value)) throw Error("the motion holds a position that is not finite");
  }
  const std::vector<std::vector<int>> children = children_of(skeleton);
  const int joints = skeleton.joints();
  Pose22 pose;
  pose.rest_offsets = fit_rest_offsets(motion, skeleton, children);
  const std::vector<bool> free = free_joints(children);
  for (int t = 0; t < motion.frames; ++t) {
    pose.root.push_back(joint_position(motion, t, kIkPelvis));
    const std::vector<Quat> world = solve_frame(motion, t, pose.rest_offsets, children, free);
    for (int j = 0; j < joints; ++j) {
      const int parent = skeleton.parents[j];
      pose.local.push_back(
          (parent >= 0 ? world[parent].conjugate() * world[j] : world[j]).normalized());
      pose.translations.push_back(
          free[j] ? Vec3(world[parent].conjugate() *
                         (joint_position(motion, t, j) - joint_position(motion, t, parent)))
                  : pose.rest_offsets[j]);
      const double misfit = (pose.translations.back() - pose.rest_offsets[j]).norm();
      if (misfit > kRigidMetres) pose.rigid = false;
    }
  }
  return pose;
}

Bvh motion_to_bvh(const Motion& motion) {
  const Skeleton& skeleton = humanml_skeleton();
  const Pose22 pose = solve_pose(motion);
  const std::vector<std::vector<int>> children = children_of(skeleton);
  const std::vector<bool> free = free_joints(children);
  const std::vector<int>& order = bvh_order();
  Bvh bvh;
  bvh.frames = motion.frames;
  bvh.frame_time = 1 / skeleton.fps;
  for (const int j : order) {
    BvhJoint joint;
    joint.name = bvh_names()[j];
    const auto parent = std::find(order.begin(), order.end(), skeleton.parents[j]);
    joint.parent = j == kIkPelvis ? -1 : static_cast<int>(parent - order.begin());
    joint.offset = pose.rest_offsets[j] * 100;
    joint.first_channel = bvh.channels;
    if (j == kIkPelvis || (!pose.rigid && free[j])) joint.channels = {0, 1, 2};
    joint.channels.insert(joint.channels.end(), {5, 4, 3});
    if (children[j].empty()) joint.end_site = end_site_offset(j);
    bvh.channels += static_cast<int>(joint.channels.size());
    bvh.joints.push_back(std::move(joint));
  }
  std::vector<Vec3> before(order.size(), Vec3::Zero());
  for (int t = 0; t < motion.frames; ++t) {
    for (size_t k = 0; k < order.size(); ++k) {
      const int j = order[k];
      const size_t at = static_cast<size_t>(t) * order.size() + j;
      if (bvh.joints[k].channels.size() == 6) {
        const Vec3& position = j == kIkPelvis ? pose.root[t] : pose.translations[at];
        for (int axis = 0; axis < 3; ++axis) {
          bvh.values.push_back(static_cast<float>(position[axis] * 100));
        }
      }
      before[j] = unwrapped(euler_zyx(pose.local[at]), before[j]);
      for (int i = 0; i < 3; ++i) {
        bvh.values.push_back(static_cast<float>(before[j][i] * 180 / M_PI));
      }
    }
  }
  return bvh;
}

}  // namespace remomask::formats
