#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "formats/bvh.h"
#include "motion/vector.h"

namespace remomask::formats {

/// A point of a source skeleton: from + weight (to - from).
struct MappedPoint {
  std::string from;
  std::string to;  ///< empty: a point of `from`: its End Site, or at `offset`, or itself
  bool end_site = false;
  std::optional<Vec3> offset;  ///< in the axes of `from`, file units: a point fixed to it
  double weight = 0;
};

/// Where the 22 joints lie in another skeleton (formats/skeleton_maps.json).
struct SkeletonMap {
  std::string name;
  std::array<MappedPoint, 22> points;
  std::vector<std::string> identify;  ///< further joints that must exist
};

/// Maps from JSON: {"skeletons": {NAME: {JOINT: POINT, ...}}} or one bare map.
/// Throws FileError; `path` also names a bare map.
std::vector<SkeletonMap> parse_skeleton_maps(const std::string& json, const std::string& path);

/// The maps that are built in.
const std::vector<SkeletonMap>& shipped_skeleton_maps();

/// The map whose joints all exist in `bvh`; if there are several, the one that names the most
/// joints. A common prefix as in "mixamorig:Hips" is ignored. Throws FileError (naming `path`) with
/// what the closest map misses.
const SkeletonMap& find_skeleton_map(const std::vector<SkeletonMap>& maps, const Bvh& bvh,
                                     const std::string& path);

/// Computes the 22 joints of a BVH file by a map that fits it.
class MappedKinematics {
 public:
  MappedKinematics(const Bvh& bvh, const SkeletonMap& map);
  /// 22 x 3 floats in the file's units and axes.
  void positions(int frame, float* out);
  void rest_positions(float* out);

 private:
  void blend(float* out) const;
  BvhKinematics kinematics_;
  std::array<float, 22> weights_;
  std::vector<float> ends_;  // 22 x (from, to) x 3
};

}  // namespace remomask::formats
