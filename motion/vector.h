#pragma once

#include <Eigen/Dense>

#include "remomask/motion.h"
#include "remomask/skeleton.h"

namespace remomask {

using Vec3 = Eigen::Vector3d;
using Quat = Eigen::Quaterniond;

/// Position of a joint, metres.
inline Vec3 joint_position(const Motion& motion, int frame, int joint) {
  const float* p = motion.at(frame, joint);
  return {p[0], p[1], p[2]};
}

inline void set_joint_position(Motion& motion, int frame, int joint, const Vec3& position) {
  float* p = motion.at(frame, joint);
  for (int axis = 0; axis < 3; ++axis) p[axis] = static_cast<float>(position[axis]);
}

/// Unit direction of the bone that ends in the joint, in the T-pose; zero for the root.
inline Vec3 rest_direction(const Skeleton& skeleton, size_t joint) {
  return Vec3(skeleton.rest_directions[joint].data());
}

}  // namespace remomask
