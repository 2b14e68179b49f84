#include "rig/forward_kinematics.h"

#include "rig/rest_skeleton.h"

namespace remomask::rig {

WorldPose world_pose(const JointRotations& motion, int frame) {
  const auto joints = static_cast<size_t>(motion.joints());
  WorldPose pose;
  pose.positions.resize(joints);
  pose.rotations.resize(joints);
  for (size_t j = 0; j < joints; ++j) {
    const Quat local = to_quat(motion.rotation(frame, static_cast<int>(j)));
    if (motion.parents[j] < 0) {
      pose.positions[j] = to_vec(motion.root[static_cast<size_t>(frame)]);
      pose.rotations[j] = local;
      continue;
    }
    const auto parent = static_cast<size_t>(motion.parents[j]);
    pose.positions[j] =
        pose.positions[parent] + pose.rotations[parent] * to_vec(motion.rest_offsets[j]);
    pose.rotations[j] = pose.rotations[parent] * local;
  }
  return pose;
}

Motion joint_positions(const JointRotations& motion) {
  const int above = motion.joints() - static_cast<int>(kRigJoints);
  Motion result(motion.frames, static_cast<int>(kRigJoints));
  result.fps = motion.fps;
  for (int t = 0; t < motion.frames; ++t) {
    const WorldPose pose = world_pose(motion, t);
    for (int j = 0; j < result.joints; ++j) {
      set_joint_position(result, t, j,
                         pose.positions[static_cast<size_t>(j) + static_cast<size_t>(above)]);
    }
  }
  return result;
}

void choose_signs(JointRotations& motion) {
  const auto joints = static_cast<size_t>(motion.joints());
  for (size_t i = joints; i < motion.rotations.size(); ++i) {
    const Quaternion& before = motion.rotations[i - joints];
    Quaternion& now = motion.rotations[i];
    double product = 0;
    for (size_t k = 0; k < now.size(); ++k) product += before[k] * now[k];
    if (product >= 0) continue;
    for (float& value : now) value = -value;
  }
}

}  // namespace remomask::rig
