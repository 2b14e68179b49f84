#include "formats/own_skeleton.h"

#include "rig/joint_names.h"

namespace remomask::formats {

std::optional<SkeletonMap> own_skeleton_map(const Bvh& bvh) {
  std::vector<std::string> names;
  for (const BvhJoint& joint : bvh.joints) names.push_back(joint.name);
  const rig::NamePreset* preset = rig::find_name_preset(names);
  if (!preset) return std::nullopt;
  SkeletonMap map;
  map.name = "remomask";
  for (size_t j = 0; j < map.points.size(); ++j) map.points[j].from = preset->joints[j];
  return map;
}

}  // namespace remomask::formats
