#pragma once

#include <array>
#include <vector>

#include "formats/bvh.h"
#include "rig/skeleton_map.h"

namespace remomask::formats {

rig::SkeletonView view_of(const Bvh& bvh);

/// Computes the 22 joints of a BVH file by a map that fits it.
class MappedKinematics {
 public:
  MappedKinematics(const Bvh& bvh, const rig::SkeletonMap& map);
  /// 22 x 3 floats in the file's units and axes.
  void positions(int frame, float* out);
  void rest_positions(float* out);

 private:
  using Points = std::array<rig::PlacedPoint, 22>;
  MappedKinematics(const Bvh& bvh, const Points& points);
  void blend(float* out) const;
  BvhKinematics kinematics_;
  std::array<float, 22> weights_;
  std::vector<float> ends_;  // 22 x (from, to) x 3
};

}  // namespace remomask::formats
