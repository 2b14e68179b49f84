#include "rig/skeleton_view.h"

namespace remomask::rig {

namespace {

SkeletonPose pose_of(const SourceMotion& source, int frame) {
  SkeletonPose pose;
  pose.positions = world_positions(source, frame);
  const size_t count = source.joints.size();
  pose.rotations.resize(count);
  for (size_t j = 0; j < count; ++j) {
    Quat rotation = source.joints[j].rotation;
    if (frame >= 0) {
      const float* q = source.rotations.data() + (static_cast<size_t>(frame) * count + j) * 4;
      rotation = Quat(q[3], q[0], q[1], q[2]);
    }
    const int parent = source.joints[j].parent;
    pose.rotations[j] =
        parent < 0 ? rotation : pose.rotations[static_cast<size_t>(parent)] * rotation;
  }
  return pose;
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
  view.rest = pose_of(source, -1);
  view.first = source.frames > 0 ? pose_of(source, 0) : view.rest;
  return view;
}

}  // namespace remomask::rig
