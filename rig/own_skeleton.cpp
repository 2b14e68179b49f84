#include "rig/own_skeleton.h"

#include "rig/joint_names.h"

namespace remomask::rig {

std::optional<SkeletonMap> own_skeleton_map(const SkeletonView& skeleton) {
  const NamePreset* preset = find_name_preset(skeleton.names);
  if (!preset) return std::nullopt;
  SkeletonMap map;
  map.name = "remomask";
  for (size_t j = 0; j < map.points.size(); ++j) map.points[j].from = preset->joints[j];
  return map;
}

}  // namespace remomask::rig
