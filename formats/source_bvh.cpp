#include "formats/source_bvh.h"

#include <algorithm>
#include <cmath>

#include "rig/skeleton_view.h"

namespace remomask::formats {

namespace {

/// Whether a joint ever leaves its place on its parent.
bool joint_moves(const rig::SourceMotion& source, size_t joint) {
  const Vec3& rest = source.joints[joint].offset;
  const double tolerance = 1e-4 * std::max(1e-3, rest.norm());
  for (int t = 0; t < source.frames; ++t) {
    const float* place =
        source.translations.data() + (static_cast<size_t>(t) * source.joints.size() + joint) * 3;
    if ((Vec3(place[0], place[1], place[2]) - rest).norm() > tolerance) return true;
  }
  return false;
}

/// Angles z, y, x in degrees, the ones nearest to those of the frame before.
Vec3 zyx_degrees(const Quat& turn, const Vec3& before) {
  const Eigen::Matrix3d m = turn.toRotationMatrix();
  const double y = std::asin(std::clamp(-m(2, 0), -1.0, 1.0));
  const Vec3 first(std::atan2(m(1, 0), m(0, 0)), y, std::atan2(m(2, 1), m(2, 2)));
  const Vec3 second(first[0] + M_PI, M_PI - y, first[2] + M_PI);
  const auto near = [&](const Vec3& angles) {
    Vec3 result;
    for (int i = 0; i < 3; ++i) {
      const double degrees = angles[i] * 180 / M_PI;
      result[i] = before[i] + std::remainder(degrees - before[i], 360);
    }
    return result;
  };
  const Vec3 a = near(first), b = near(second);
  return (a - before).squaredNorm() <= (b - before).squaredNorm() ? a : b;
}

}  // namespace

rig::SourceMotion rest_of_bvh(const Bvh& bvh) {
  rig::SourceMotion rig;
  for (const BvhJoint& joint : bvh.joints) {
    rig.joints.push_back(
        {joint.name, joint.parent, joint.offset, Quat::Identity(), joint.end_site});
  }
  return rig;
}

Bvh source_to_bvh(const rig::SourceMotion& source) {
  const size_t count = source.joints.size();
  const rig::SkeletonPose rest = rig::view_of(source).rest;
  Bvh bvh;
  bvh.frames = source.frames;
  bvh.frame_time = 1 / source.fps;
  std::vector<bool> has_child(count, false);
  for (size_t j = 0; j < count; ++j) {
    const rig::SourceJoint& from = source.joints[j];
    const bool root = from.parent < 0;
    if (!root) has_child[static_cast<size_t>(from.parent)] = true;
    BvhJoint joint;
    joint.name = from.name;
    joint.parent = from.parent;
    joint.offset = root
                       ? rest.positions[j]
                       : Vec3(rest.positions[j] - rest.positions[static_cast<size_t>(from.parent)]);
    joint.first_channel = bvh.channels;
    if (root || joint_moves(source, j)) joint.channels = {0, 1, 2};
    joint.channels.insert(joint.channels.end(), {5, 4, 3});
    bvh.channels += static_cast<int>(joint.channels.size());
    bvh.joints.push_back(std::move(joint));
  }
  for (size_t j = 0; j < count; ++j) {
    if (has_child[j]) continue;
    bvh.joints[j].end_site = source.joints[j].end_site
                                 ? Vec3(rest.rotations[j] * *source.joints[j].end_site)
                                 : Vec3(bvh.joints[j].offset * 0.5);
  }
  std::vector<Vec3> before(count, Vec3::Zero());
  for (int t = 0; t < source.frames; ++t) {
    for (size_t j = 0; j < count; ++j) {
      const size_t at = static_cast<size_t>(t) * count + j;
      const float *q = source.rotations.data() + at * 4, *p = source.translations.data() + at * 3;
      const int above = source.joints[j].parent;
      const Quat parent = above < 0 ? Quat::Identity() : rest.rotations[static_cast<size_t>(above)];
      if (bvh.joints[j].channels.size() == 6) {
        const Vec3 place = parent * Vec3(p[0], p[1], p[2]);
        for (int axis = 0; axis < 3; ++axis) {
          bvh.values.push_back(static_cast<float>(place[axis]));
        }
      }
      const Quat turn = parent * Quat(q[3], q[0], q[1], q[2]) * rest.rotations[j].conjugate();
      before[j] = zyx_degrees(turn, before[j]);
      for (int i = 0; i < 3; ++i) bvh.values.push_back(static_cast<float>(before[j][i]));
    }
  }
  return bvh;
}

}  // namespace remomask::formats
