#pragma once

#include <array>
#include <vector>

#include "rig/skeleton_map.h"

namespace remomask::rig {

/// Computes the 22 joints of a motion by a map that fits its skeleton. Only the joints that the
/// map needs, and those above them, are computed.
class MappedSource {
 public:
  MappedSource(const SourceMotion& source, const SkeletonMap& map);
  /// 22 x 3 floats in the file's units and axes; the rest pose for frame -1.
  void positions(int frame, float* out);

 private:
  const SourceMotion& source_;
  std::array<PlacedPoint, 22> points_;
  std::vector<size_t> needed_;
  SkeletonPose world_;
};

}  // namespace remomask::rig
