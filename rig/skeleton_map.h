#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "motion/vector.h"
#include "rig/skeleton_view.h"

namespace remomask::rig {

/// A point of a source skeleton: from + weight (to - from).
struct MappedPoint {
  std::string from;
  std::string to;  ///< empty: a point of `from`: its End Site, or at `offset`, or itself
  bool end_site = false;
  std::optional<Vec3> offset;  ///< in the axes of `from`, file units: a point fixed to it
  double weight = 0;
};

/// Where the 22 joints lie in another skeleton (rig/skeleton_maps.json).
struct SkeletonMap {
  std::string name;
  std::array<MappedPoint, 22> points;
  std::vector<std::string> identify;  ///< further joints that must exist
};

/// Maps from JSON: {"skeletons": {NAME: {JOINT: POINT, ...}}} or one bare map.
/// Throws FileError; `path` also names a bare map.
std::vector<SkeletonMap> parse_skeleton_maps(const std::string& json, const std::string& path);

/// The maps as JSON that parse_skeleton_maps() reads.
std::string format_skeleton_maps(const std::vector<SkeletonMap>& maps);

/// The maps that are built in.
const std::vector<SkeletonMap>& shipped_skeleton_maps();

/// What of a map a skeleton lacks: joints by name, End Sites as "end of NAME"; empty if it fits.
/// A namespace as in "mixamorig:Hips" is overlooked.
std::vector<std::string> missing_joints(const SkeletonMap& map, const SkeletonView& skeleton);

/// The map that fits; if there are several, the one that names the most joints; null if none does.
const SkeletonMap* fitting_skeleton_map(const std::vector<SkeletonMap>& maps,
                                        const SkeletonView& skeleton);

/// A mapped point by the numbers of the joints: from + weight (to + its offset - from).
struct PlacedPoint {
  int from = 0, to = 0;
  Vec3 offset = Vec3::Zero();  ///< in the axes of `to`
  double weight = 0;
};

/// The points of a map that fits. Throws Error if it does not.
std::array<PlacedPoint, 22> place_points(const SkeletonMap& map, const SkeletonView& skeleton);

}  // namespace remomask::rig
