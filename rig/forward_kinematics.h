#pragma once

#include <array>
#include <vector>

#include "motion/vector.h"
#include "remomask/rotations.h"

namespace remomask::rig {

inline Vec3 to_vec(const Vector3& v) { return {v[0], v[1], v[2]}; }
inline Quat to_quat(const Quaternion& q) { return Quat(q[3], q[0], q[1], q[2]); }

inline Vector3 from_vec(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}
inline Quaternion from_quat(const Quat& q) {
  return {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
          static_cast<float>(q.w())};
}

/// Where the joints of one frame are and how they are turned, in the world.
struct WorldPose {
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
};

WorldPose world_pose(const JointRotations& motion, int frame);

/// The joint positions of all frames. A joint "Root" above the pelvis is left out.
Motion joint_positions(const JointRotations& motion);

/// q and -q are the same rotation: takes the one nearer to the frame before, so that programs that
/// interpolate the four numbers go the short way.
void choose_signs(JointRotations& motion);

}  // namespace remomask::rig
