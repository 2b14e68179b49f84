#include "rig/own_skeleton.h"

#include <algorithm>
#include <cmath>

#include "remomask/skeleton.h"
#include "rig/joint_names.h"

namespace remomask::rig {

namespace {

/// Pelvis and chest keep a captured performer's shape in our files; legs and arms have our lengths.
constexpr size_t kLimbBones[] = {4, 5, 7, 8, 18, 19, 20, 21};
constexpr double kLengthTolerance = 0.005;

/// Whether the bones of the limbs are as long to each other as ours, whatever the unit. The rest
/// pose is not asked for, since FBX files have none that is sure.
bool has_our_limbs(const SkeletonView& skeleton, const NamePreset& preset) {
  const auto place = [&](size_t joint) {
    return skeleton.first.positions[static_cast<size_t>(skeleton.find_joint(preset.joints[joint]))];
  };
  const Skeleton& ours = humanml_skeleton();
  double least = INFINITY, most = 0;
  for (const size_t joint : kLimbBones) {
    const double length = (place(joint) - place(static_cast<size_t>(ours.parents[joint]))).norm();
    const double ratio = length / ours.bone_lengths[joint];
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  return least > 0 && most < least * (1 + kLengthTolerance);
}

}  // namespace

std::optional<SkeletonMap> own_skeleton_map(const SkeletonView& skeleton) {
  const NamePreset* preset = find_name_preset(skeleton.names);
  const bool exact = preset && skeleton.size() == preset->joints.size() + 1 &&
                     skeleton.find_joint(preset->root) >= 0;
  if (!preset || (!exact && !has_our_limbs(skeleton, *preset))) return std::nullopt;
  SkeletonMap map;
  // What another program has written anew may begin with a rest pose; a file of ours does not.
  map.name = exact ? "remomask" : "remomask_names";
  for (size_t j = 0; j < map.points.size(); ++j) map.points[j].from = preset->joints[j];
  return map;
}

}  // namespace remomask::rig
