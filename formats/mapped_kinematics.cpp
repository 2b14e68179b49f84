#include "formats/mapped_kinematics.h"

#include <algorithm>

namespace remomask::formats {

namespace {

/// Origin and axes of every joint: the four points that tell both.
std::vector<BvhPoint> frames_of_joints(const Bvh& bvh) {
  std::vector<BvhPoint> points;
  for (size_t j = 0; j < bvh.joints.size(); ++j) {
    const int joint = static_cast<int>(j);
    points.push_back({joint, Vec3::Zero()});
    for (int axis = 0; axis < 3; ++axis) points.push_back({joint, Vec3::Unit(axis)});
  }
  return points;
}

rig::SkeletonPose first_pose(const Bvh& bvh) {
  std::vector<float> points(bvh.joints.size() * 12);
  BvhKinematics(bvh, frames_of_joints(bvh)).positions(0, points.data());
  rig::SkeletonPose pose;
  for (size_t j = 0; j < bvh.joints.size(); ++j) {
    const Eigen::Matrix<double, 3, 4> p =
        Eigen::Map<const Eigen::Matrix<float, 3, 4>>(points.data() + j * 12).cast<double>();
    Eigen::Matrix3d axes = p.rightCols<3>().colwise() - p.col(0);
    pose.positions.push_back(p.col(0));
    pose.rotations.push_back(Quat(axes).normalized());
  }
  return pose;
}

/// Zero rotations. A file whose bones are in position channels alone has no OFFSETs worth the
/// name: its first frame says how long they are.
rig::SkeletonPose rest_pose(const Bvh& bvh) {
  const bool no_offsets = std::all_of(bvh.joints.begin(), bvh.joints.end(), [](const BvhJoint& j) {
    return j.parent < 0 || j.offset.isZero(1e-9);
  });
  rig::SkeletonPose pose;
  for (const BvhJoint& joint : bvh.joints) {
    Vec3 offset = joint.offset;
    if (no_offsets && bvh.frames > 0) {
      for (size_t c = 0; c < joint.channels.size(); ++c) {
        if (joint.channels[c] > 2) continue;
        offset[joint.channels[c]] = bvh.values[static_cast<size_t>(joint.first_channel) + c];
      }
    }
    const bool root = joint.parent < 0;
    pose.positions.push_back(root ? offset : pose.positions[joint.parent] + offset);
    pose.rotations.push_back(Quat::Identity());
  }
  return pose;
}

}  // namespace

rig::SkeletonView view_of(const Bvh& bvh) {
  rig::SkeletonView view;
  for (const BvhJoint& joint : bvh.joints) {
    view.names.push_back(joint.name);
    view.parents.push_back(joint.parent);
    view.end_sites.push_back(joint.end_site);
  }
  view.rest = rest_pose(bvh);
  view.first = bvh.frames > 0 ? first_pose(bvh) : view.rest;
  return view;
}

MappedKinematics::MappedKinematics(const Bvh& bvh, const rig::SkeletonMap& map)
    : MappedKinematics(bvh, rig::place_points(map, view_of(bvh))) {}

MappedKinematics::MappedKinematics(const Bvh& bvh, const Points& points)
    : kinematics_(bvh,
                  [&] {
                    std::vector<BvhPoint> ends;
                    for (const rig::PlacedPoint& point : points) {
                      ends.push_back({point.from, Vec3::Zero()});
                      ends.push_back({point.to, point.offset});
                    }
                    return ends;
                  }()),
      ends_(22 * 6) {
  for (size_t j = 0; j < points.size(); ++j) weights_[j] = static_cast<float>(points[j].weight);
}

void MappedKinematics::blend(float* out) const {
  for (size_t j = 0; j < weights_.size(); ++j) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const float from = ends_[j * 6 + axis], to = ends_[j * 6 + 3 + axis];
      *out++ = from + weights_[j] * (to - from);
    }
  }
}

void MappedKinematics::positions(int frame, float* out) {
  kinematics_.positions(frame, ends_.data());
  blend(out);
}

void MappedKinematics::rest_positions(float* out) {
  kinematics_.rest_positions(ends_.data());
  blend(out);
}

}  // namespace remomask::formats
