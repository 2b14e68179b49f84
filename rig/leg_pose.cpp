#include "rig/leg_pose.h"

#include "kinematics/pose_fit.h"
#include "motion/rotation.h"
#include "rig/forward_kinematics.h"

namespace remomask::rig {

void put_foot(JointRotations& figure, int frame, size_t ankle, const Quat& foot, Vec3 target) {
  const auto knee = static_cast<size_t>(figure.parents[ankle]);
  const auto hip = static_cast<size_t>(figure.parents[knee]);
  const auto pelvis = static_cast<size_t>(figure.parents[hip]);
  const WorldPose now = world_pose(figure, frame);
  const double upper = to_vec(figure.rest_offsets[knee]).norm();
  const double lower = to_vec(figure.rest_offsets[ankle]).norm();
  const Vec3 bent =
      kinematics::bend_joint(now.positions[hip], target, now.positions[knee], upper, lower);
  const Quat thigh =
      motion::shortest_arc(now.positions[knee] - now.positions[hip], bent - now.positions[hip]) *
      now.rotations[hip];
  const Quat shin =
      motion::shortest_arc(now.positions[ankle] - now.positions[knee], target - bent) *
      now.rotations[knee];
  const auto first = static_cast<size_t>(frame) * figure.parents.size();
  figure.rotations[first + hip] =
      from_quat((now.rotations[pelvis].conjugate() * thigh).normalized());
  figure.rotations[first + knee] = from_quat((thigh.conjugate() * shin).normalized());
  figure.rotations[first + ankle] = from_quat((shin.conjugate() * foot).normalized());
}

}  // namespace remomask::rig
