#include "motion/rest_pose.h"

#include <algorithm>

namespace remomask::motion {

namespace {

std::vector<Vec3> make_t_pose(const Skeleton& skeleton) {
  std::vector<Vec3> directions;
  for (size_t j = 0; j < skeleton.parents.size(); ++j)
    directions.push_back(rest_direction(skeleton, j));
  for (const std::vector<int>& chain : skeleton.chains) {
    const auto holds = [&](int joint) {
      return std::find(chain.begin(), chain.end(), joint) != chain.end();
    };
    const bool leg = holds(skeleton.right_hip) || holds(skeleton.left_hip);
    const bool arm = holds(skeleton.right_shoulder) || holds(skeleton.left_shoulder);
    if (!leg && !arm) continue;
    const bool right = holds(skeleton.right_hip) || holds(skeleton.right_shoulder);
    const Vec3 outward(right ? -1 : 1, 0, 0);
    // Hips go sideways and the rest of the leg keeps its direction; arms are
    // stretched out over their whole length.
    for (size_t i = 1; i < chain.size(); ++i) {
      if (arm || i == 1) directions[chain[i]] = outward;
    }
  }
  return directions;
}

}  // namespace

const std::vector<Vec3>& t_pose_directions(const Skeleton& skeleton) {
  static const std::vector<Vec3> humanml = make_t_pose(humanml_skeleton());
  static const std::vector<Vec3> kit = make_t_pose(kit_skeleton());
  return skeleton.joints() == kit_skeleton().joints() ? kit : humanml;
}

}  // namespace remomask::motion
