#include "rig/skeleton_view.h"

#include <algorithm>

namespace remomask::rig {

namespace {

Quat rotation_of(const SourceMotion& source, int frame, size_t joint) {
  const float* q =
      source.rotations.data() + (static_cast<size_t>(frame) * source.joints.size() + joint) * 4;
  return Quat(q[3], q[0], q[1], q[2]);
}

Vec3 translation_of(const SourceMotion& source, int frame, size_t joint) {
  const float* t =
      source.translations.data() + (static_cast<size_t>(frame) * source.joints.size() + joint) * 3;
  return Vec3(t[0], t[1], t[2]);
}

/// Joints placed by local rotations and translations.
template <typename Rotation, typename Translation>
SkeletonPose place(const SourceMotion& source, Rotation rotation, Translation translation) {
  SkeletonPose pose;
  for (size_t j = 0; j < source.joints.size(); ++j) {
    const int parent = source.joints[j].parent;
    if (parent < 0) {
      pose.positions.push_back(translation(j));
      pose.rotations.push_back(rotation(j));
      continue;
    }
    const Quat& above = pose.rotations[static_cast<size_t>(parent)];
    pose.positions.push_back(pose.positions[static_cast<size_t>(parent)] + above * translation(j));
    pose.rotations.push_back(above * rotation(j));
  }
  return pose;
}

/// A file whose bones are in the translations of its frames alone has no rest offsets worth the
/// name: its first frame says how long they are.
SkeletonPose rest_pose(const SourceMotion& source) {
  const bool no_offsets = std::all_of(
      source.joints.begin(), source.joints.end(),
      [](const SourceJoint& joint) { return joint.parent < 0 || joint.offset.isZero(1e-9); });
  return place(
      source, [&](size_t j) { return source.joints[j].rotation; },
      [&](size_t j) {
        return no_offsets && source.frames > 0 ? translation_of(source, 0, j)
                                               : source.joints[j].offset;
      });
}

}  // namespace

int SkeletonView::find_joint(std::string_view name) const {
  for (size_t j = 0; j < names.size(); ++j) {
    if (names[j] == name) return static_cast<int>(j);
  }
  return -1;
}

std::vector<int> SkeletonView::path_to_root(int joint) const {
  std::vector<int> path;
  for (int j = joint; j >= 0; j = parents[static_cast<size_t>(j)]) path.push_back(j);
  return path;
}

SkeletonView view_of(const SourceMotion& source) {
  SkeletonView view;
  for (const SourceJoint& joint : source.joints) {
    view.names.push_back(joint.name);
    view.parents.push_back(joint.parent);
    view.end_sites.push_back(joint.end_site);
  }
  view.rest = rest_pose(source);
  view.first = view.rest;
  if (source.frames > 0) {
    view.first = place(
        source, [&](size_t j) { return rotation_of(source, 0, j); },
        [&](size_t j) { return translation_of(source, 0, j); });
  }
  return view;
}

}  // namespace remomask::rig
