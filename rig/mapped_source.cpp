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
  for (const size_t j : needed_) {
    place_joint(source_, frame, j, world_.positions, world_.rotations);
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
