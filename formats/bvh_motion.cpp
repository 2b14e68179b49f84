#include "formats/bvh_motion.h"

#include <algorithm>
#include <cmath>

#include "rig/forward_kinematics.h"

namespace remomask::formats {

namespace {

/// Joints in the order in which BVH nests them: each before its children, siblings as they are.
void add_with_children(const std::vector<int>& parents, int joint, std::vector<int>& order) {
  order.push_back(joint);
  for (int child = joint + 1; child < static_cast<int>(parents.size()); ++child) {
    if (parents[static_cast<size_t>(child)] == joint) add_with_children(parents, child, order);
  }
}

/// Angles z, y, x of R = Rz Ry Rx in radians.
Vec3 euler_zyx(const Quat& q) {
  const Eigen::Matrix3d m = q.toRotationMatrix();
  const double y = std::asin(std::clamp(-m(2, 0), -1.0, 1.0));
  return {std::atan2(m(1, 0), m(0, 0)), y, std::atan2(m(2, 1), m(2, 2))};
}

/// Angles y, x, z of R = Ry Rx Rz in radians: a body can face anywhere without a gimbal lock, which
/// lies where it lies on its front or back.
Vec3 euler_yxz(const Quat& q) {
  const Eigen::Matrix3d m = q.toRotationMatrix();
  const double x = std::asin(std::clamp(-m(1, 2), -1.0, 1.0));
  return {std::atan2(m(0, 2), m(2, 2)), x, std::atan2(m(1, 0), m(1, 1))};
}

/// The heading is on the root, or on the hips below it.
bool carries_heading(const JointRotations& motion, int joint) {
  return joint == 0 || motion.parents[static_cast<size_t>(joint)] == 0;
}

Vec3 nearest_turns(Vec3 angles, const Vec3& before) {
  for (int i = 0; i < 3; ++i) {
    angles[i] = before[i] + std::remainder(angles[i] - before[i], 2 * M_PI);
  }
  return angles;
}

/// The same rotation by the angles closest to those of the previous frame.
Vec3 unwrapped_angles(const Vec3& angles, const Vec3& before) {
  const Vec3 first = nearest_turns(angles, before);
  const Vec3 other(angles[0] + M_PI, M_PI - angles[1], angles[2] + M_PI);
  const Vec3 second = nearest_turns(other, before);
  return (first - before).squaredNorm() <= (second - before).squaredNorm() ? first : second;
}

}  // namespace

Bvh rotations_to_bvh(const JointRotations& motion, double units_per_metre) {
  std::vector<int> order;
  add_with_children(motion.parents, 0, order);
  Bvh bvh;
  bvh.frames = motion.frames;
  bvh.frame_time = 1 / motion.fps;
  std::vector<int> place(order.size());
  for (size_t k = 0; k < order.size(); ++k)
    place[static_cast<size_t>(order[k])] = static_cast<int>(k);
  for (const int j : order) {
    const auto at = static_cast<size_t>(j);
    BvhJoint joint;
    joint.name = motion.joint_names[at];
    joint.parent = j == 0 ? -1 : place[static_cast<size_t>(motion.parents[at])];
    joint.offset = rig::to_vec(motion.rest_offsets[at]) * units_per_metre;
    joint.first_channel = bvh.channels;
    if (j == 0) joint.channels = {0, 1, 2};
    const std::initializer_list<BvhChannel> turns = {5, 4, 3}, heading_first = {4, 3, 5};
    joint.channels.insert(joint.channels.end(), carries_heading(motion, j) ? heading_first : turns);
    const Vec3 tip = rig::to_vec(motion.tips[at]);
    if (tip.squaredNorm() > 0) joint.end_site = Vec3(tip * units_per_metre);
    bvh.channels += static_cast<int>(joint.channels.size());
    bvh.joints.push_back(std::move(joint));
  }
  std::vector<Vec3> before(order.size(), Vec3::Zero());
  for (int t = 0; t < motion.frames; ++t) {
    for (const int j : order) {
      if (j == 0) {
        const Vec3 position = rig::to_vec(motion.root[static_cast<size_t>(t)]) * units_per_metre;
        for (int axis = 0; axis < 3; ++axis) {
          bvh.values.push_back(static_cast<float>(position[axis]));
        }
      }
      Vec3& angles = before[static_cast<size_t>(j)];
      const Quat rotation = rig::to_quat(motion.rotation(t, j));
      angles = unwrapped_angles(
          carries_heading(motion, j) ? euler_yxz(rotation) : euler_zyx(rotation), angles);
      for (int i = 0; i < 3; ++i) {
        bvh.values.push_back(static_cast<float>(angles[i] * 180 / M_PI));
      }
    }
  }
  return bvh;
}

}  // namespace remomask::formats
