#pragma once

#include <vector>

#include "motion/skeleton.h"

namespace remomask {

/// Joint positions over time: the stored truth of every clip.
struct Motion {
  int frames = 0;
  int joints = 22;
  std::vector<float> positions;  ///< [frames][joints][3], metres, Y up, at the skeleton's fps

  Motion() = default;
  Motion(int frame_count, int joint_count)
      : frames(frame_count),
        joints(joint_count),
        positions(static_cast<size_t>(frame_count) * joint_count * 3, 0.f) {}

  float* at(int frame, int joint) {
    return positions.data() + (static_cast<size_t>(frame) * joints + joint) * 3;
  }
  const float* at(int frame, int joint) const {
    return positions.data() + (static_cast<size_t>(frame) * joints + joint) * 3;
  }
  Vec3 position(int frame, int joint) const {
    const float* p = at(frame, joint);
    return {p[0], p[1], p[2]};
  }
  void set(int frame, int joint, const Vec3& p) {
    float* q = at(frame, joint);
    for (int axis = 0; axis < 3; ++axis) q[axis] = static_cast<float>(p[axis]);
  }
};

/// Frames [first, last) of a motion.
Motion slice(const Motion& motion, int first, int last);

}  // namespace remomask
