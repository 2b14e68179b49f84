#include "rig/mapped_source.h"

namespace remomask::rig {

MappedSource::MappedSource(const SourceMotion& source, const SkeletonMap& map)
    : source_(source), points_(place_points(map, view_of(source))) {
  const size_t count = source.joints.size();
  std::vector<bool> wanted(count, false);
  const auto want = [&](int joint) {
    for (int j = joint; j >= 0 && !wanted[static_cast<size_t>(j)];
         j = source.joints[static_cast<size_t>(j)].parent) {
      wanted[static_cast<size_t>(j)] = true;
    }
  };
  for (const PlacedPoint& point : points_) {
    want(point.from);
    want(point.to);
  }
  for (size_t j = 0; j < count; ++j) {
    if (wanted[j]) needed_.push_back(j);
  }
  world_.positions.resize(count);
  world_.rotations.resize(count);
}

void MappedSource::positions(int frame, float* out) {
  const size_t count = source_.joints.size();
  for (const size_t j : needed_) {
    const SourceJoint& joint = source_.joints[j];
    Quat rotation = joint.rotation;
    Vec3 translation = joint.offset;
    if (frame >= 0) {
      const size_t at = static_cast<size_t>(frame) * count + j;
      const float* q = source_.rotations.data() + at * 4;
      const float* t = source_.translations.data() + at * 3;
      rotation = Quat(q[3], q[0], q[1], q[2]);
      translation = Vec3(t[0], t[1], t[2]);
    }
    if (joint.parent < 0) {
      world_.positions[j] = translation;
      world_.rotations[j] = rotation;
    } else {
      const auto parent = static_cast<size_t>(joint.parent);
      world_.positions[j] = world_.positions[parent] + world_.rotations[parent] * translation;
      world_.rotations[j] = world_.rotations[parent] * rotation;
    }
  }
  for (const PlacedPoint& point : points_) {
    const auto to = static_cast<size_t>(point.to);
    const Vec3& from = world_.positions[static_cast<size_t>(point.from)];
    const Vec3 end = world_.positions[to] + world_.rotations[to] * point.offset;
    const Vec3 position = from + point.weight * (end - from);
    for (int axis = 0; axis < 3; ++axis) *out++ = static_cast<float>(position[axis]);
  }
}

}  // namespace remomask::rig
