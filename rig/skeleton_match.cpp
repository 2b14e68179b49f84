#include "rig/skeleton_match.h"

#include "rig/humanoid_map.h"
#include "rig/humanoid_shape.h"
#include "rig/limb_names.h"
#include "rig/trunk_names.h"

namespace remomask::rig {

namespace {

Humanoid find_body_by_names(const SkeletonView& skeleton, const std::vector<NameReading>& names) {
  Humanoid body;
  for (size_t side = 0; side < 2; ++side) {
    const Side which = side == 0 ? Side::left : Side::right;
    body.legs[side] = find_leg(skeleton, names, which);
    body.arms[side] = find_arm(skeleton, names, which);
  }
  find_trunk(skeleton, names, body);
  return body;
}

}  // namespace

SkeletonMatch match_skeleton(const SkeletonView& skeleton) {
  SkeletonMatch match;
  const std::vector<NameReading> names = read_joint_names(skeleton.names);
  Humanoid body = find_body_by_names(skeleton, names);
  match.missing = missing_parts(body);
  if (!match.missing.empty()) {
    const std::optional<Humanoid> shape = find_body_by_shape(skeleton, names);
    if (!shape) return match;
    body = *shape;
    match.by_names = false;
    match.missing.clear();
  }
  match.objection = why_no_human(skeleton, names, body);
  if (match.objection.empty()) match.map = map_of_body(skeleton, body);
  return match;
}

}  // namespace remomask::rig
