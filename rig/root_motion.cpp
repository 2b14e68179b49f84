#include "rig/root_motion.h"

#include <algorithm>
#include <cmath>

#include "motion/rotation.h"
#include "rig/forward_kinematics.h"

namespace remomask::rig {

std::vector<double> headings_of(const JointRotations& motion) {
  constexpr double kShown = 0.25;
  std::vector<double> headings(static_cast<size_t>(motion.frames), 0);
  int shown = -1;
  for (int t = 0; t < motion.frames; ++t) {
    const Quat pelvis = to_quat(motion.rotation(t, 0));
    if (pelvis.w() * pelvis.w() + pelvis.y() * pelvis.y() < kShown) continue;
    double& heading = headings[static_cast<size_t>(t)];
    heading = 2 * std::atan2(pelvis.y(), pelvis.w());
    const double before = shown < 0 ? 0 : headings[static_cast<size_t>(shown)];
    heading = before + std::remainder(heading - before, 2 * M_PI);
    for (int i = shown + 1; i < t; ++i) {
      const double share = shown < 0 ? 1 : static_cast<double>(i - shown) / (t - shown);
      headings[static_cast<size_t>(i)] = before + share * (heading - before);
    }
    shown = t;
  }
  for (size_t i = static_cast<size_t>(shown) + 1; shown >= 0 && i < headings.size(); ++i) {
    headings[i] = headings[static_cast<size_t>(shown)];
  }
  return headings;
}

void keep_in_place(JointRotations& motion) {
  for (Vector3& root : motion.root) root[0] = root[2] = 0;
}

JointRotations with_root_joint(const JointRotations& motion, bool heading) {
  JointRotations result;
  result.frames = motion.frames;
  result.fps = motion.fps;
  result.joint_names = {"root"};
  result.parents = {-1};
  result.rest_offsets = {Vector3{0, 0, 0}};
  result.tips = {Vector3{0, 0, 0}};
  for (size_t j = 0; j < motion.parents.size(); ++j) {
    result.joint_names.push_back(motion.joint_names[j]);
    result.parents.push_back(motion.parents[j] + 1);
    result.rest_offsets.push_back(motion.rest_offsets[j]);
    result.tips.push_back(motion.tips[j]);
  }
  const Vec3 standing = to_vec(motion.rest_offsets[0]);
  const std::vector<double> headings = headings_of(motion);
  for (int t = 0; t < motion.frames; ++t) {
    const Quat pelvis = to_quat(motion.rotation(t, 0));
    const Quat turn = motion::yaw_rotation(heading ? headings[static_cast<size_t>(t)] : 0);
    result.root.push_back(from_vec(to_vec(motion.root[static_cast<size_t>(t)]) - standing));
    result.rotations.push_back(from_quat(turn));
    result.rotations.push_back(from_quat((turn.conjugate() * pelvis).normalized()));
    for (int j = 1; j < motion.joints(); ++j) result.rotations.push_back(motion.rotation(t, j));
  }
  choose_signs(result);
  return result;
}

}  // namespace remomask::rig
