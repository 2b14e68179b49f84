#include "remomask/rotations.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "kinematics/pose_fit.h"
#include "motion/canonical.h"
#include "remomask/error.h"
#include "rig/forward_kinematics.h"
#include "rig/inverse_kinematics.h"
#include "rig/rigid_fit.h"

namespace remomask {

namespace {

void require_solvable(const Motion& motion) {
  if (motion.joints != static_cast<int>(rig::kRigJoints)) {
    throw Error(fmt::format("rotations are solved for {} joints, this motion has {}",
                            rig::kRigJoints, motion.joints));
  }
  if (motion.frames < 1) throw Error("rotations need a motion of at least one frame");
  for (const float value : motion.positions) {
    if (!std::isfinite(value)) throw Error("the motion holds a position that is not finite");
  }
}

/// Whether the bones are as long as those of the skeleton, up to what fitting takes up.
bool has_these_bones(const Motion& motion, const rig::RestSkeleton& rest) {
  constexpr double kTolerated = 0.01;  // m
  const std::vector<double> lengths = kinematics::mean_bone_lengths(motion, humanml_skeleton());
  for (size_t j = 1; j < rig::kRigJoints; ++j) {
    if (std::abs(lengths[j] - rest.offsets[j].norm()) > kTolerated) return false;
  }
  return true;
}

/// Whether all bones, and the triangles of pelvis and chest, keep their lengths over time.
bool is_rigid(const Motion& motion) {
  constexpr double kTolerated = 0.001;  // m
  const std::vector<int>& parents = humanml_skeleton().parents;
  std::vector<std::pair<int, int>> spans = {{1, 2}, {1, 3}, {2, 3}, {12, 13}, {12, 14}, {13, 14}};
  for (int j = 1; j < static_cast<int>(rig::kRigJoints); ++j) {
    spans.emplace_back(j, parents[static_cast<size_t>(j)]);
  }
  for (const auto& [a, b] : spans) {
    const double length = (joint_position(motion, 0, a) - joint_position(motion, 0, b)).norm();
    for (int t = 1; t < motion.frames; ++t) {
      const double now = (joint_position(motion, t, a) - joint_position(motion, t, b)).norm();
      if (!(std::abs(now - length) < kTolerated)) return false;
    }
  }
  return true;
}

/// A body of other proportions takes the bone lengths first: each bone keeps its direction, and the
/// way over the ground is scaled with the legs.
Motion with_human_bones(const Motion& motion) {
  motion::CanonicalOptions only_bones;
  only_bones.floor = only_bones.origin = only_bones.facing = false;
  return motion::canonicalize(motion, humanml_skeleton(), only_bones);
}

rig::Pose pose_of(const Motion& motion, int frame) {
  rig::Pose pose;
  for (size_t j = 0; j < rig::kRigJoints; ++j) {
    pose[j] = joint_position(motion, frame, static_cast<int>(j));
  }
  return pose;
}

JointRotations solve_on(const rig::RestSkeleton& rest, const Motion& motion) {
  const rig::RigidFit fit(rest);
  std::vector<rig::Pose> poses;
  poses.reserve(static_cast<size_t>(motion.frames));
  for (int t = 0; t < motion.frames; ++t) poses.push_back(fit.fit(pose_of(motion, t)));
  const rig::WorldRotations world = rig::solve_world_rotations(poses, rest, motion.fps);
  const Skeleton& skeleton = humanml_skeleton();
  JointRotations result;
  result.frames = motion.frames;
  result.fps = motion.fps;
  result.joint_names = skeleton.joint_names;
  result.parents = skeleton.parents;
  for (size_t j = 0; j < rig::kRigJoints; ++j) {
    result.rest_offsets.push_back(rig::from_vec(rest.offsets[j]));
    result.tips.push_back(rig::from_vec(rest.tips[j]));
  }
  result.rotations.reserve(poses.size() * rig::kRigJoints);
  for (size_t t = 0; t < poses.size(); ++t) {
    result.root.push_back(rig::from_vec(poses[t][0]));
    for (size_t j = 0; j < rig::kRigJoints; ++j) {
      const int parent = skeleton.parents[j];
      const Quat local =
          parent < 0 ? world[t][j]
                     : Quat(world[t][static_cast<size_t>(parent)].conjugate() * world[t][j]);
      result.rotations.push_back(rig::from_quat(local.normalized()));
    }
  }
  rig::choose_signs(result);
  return result;
}

}  // namespace

JointRotations solve_rotations(const Motion& motion, const RotationOptions& options) {
  require_solvable(motion);
  if (options.own_proportions) return solve_on(rig::performer_rest(motion), motion);
  const rig::RestSkeleton& rest = rig::human_rest();
  const bool fits = has_these_bones(motion, rest);
  if (options.keep_rigid && fits && is_rigid(motion)) {
    return solve_on(rig::performer_rest(motion), motion);
  }
  return solve_on(rest, fits ? motion : with_human_bones(motion));
}

}  // namespace remomask
