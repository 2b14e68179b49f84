#include "generator/motion_finish.h"

#include <algorithm>

namespace remomask {

void impose_bone_lengths(Motion& motion, const Skeleton& skeleton) {
  std::vector<Vec3> before(static_cast<size_t>(motion.joints));
  for (int frame = 0; frame < motion.frames; ++frame) {
    for (int joint = 0; joint < motion.joints; ++joint) {
      before[static_cast<size_t>(joint)] = motion.position(frame, joint);
    }
    for (int joint = 0; joint < motion.joints; ++joint) {
      const int parent = skeleton.parents[static_cast<size_t>(joint)];
      if (parent < 0) continue;
      Vec3 direction = before[static_cast<size_t>(joint)] - before[static_cast<size_t>(parent)];
      if (direction.norm() < 1e-6) {
        direction = skeleton.rest_directions[static_cast<size_t>(joint)];
      }
      motion.set(frame, joint,
                 motion.position(frame, parent) +
                     skeleton.bone_lengths[static_cast<size_t>(joint)] * direction.normalized());
    }
  }
}

double lift_to_floor(Motion& motion, const Skeleton& skeleton, double tolerance) {
  double lowest = 0;
  for (int frame = 0; frame < motion.frames; ++frame) {
    for (const auto* feet : {&skeleton.left_feet, &skeleton.right_feet}) {
      for (const int joint : *feet) lowest = std::min(lowest, motion.position(frame, joint).y());
    }
  }
  if (lowest >= -tolerance) return 0;
  for (int frame = 0; frame < motion.frames; ++frame) {
    for (int joint = 0; joint < motion.joints; ++joint) {
      motion.at(frame, joint)[1] -= static_cast<float>(lowest);
    }
  }
  return -lowest;
}

}  // namespace remomask
