#include "rig/root_motion.h"

#include <algorithm>
#include <cmath>

#include "motion/rotation.h"
#include "rig/forward_kinematics.h"

namespace remomask::rig {

namespace {

constexpr double kLongestSpread = 1;               // s
constexpr double kTravelled = 0.3, kTurned = 0.5;  // m, rad

/// The heading of each frame in radians: the turn about +Y that is in the pelvis' rotation, without
/// jumps of whole turns. A body that is nearly upside down shows none; there it goes straight on
/// from the frame before to the frame after.
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

double smooth(double share) { return share * share * (3 - 2 * share); }

}  // namespace

void keep_in_place(JointRotations& motion) {
  for (Vector3& root : motion.root) root[0] = root[2] = 0;
}

LoopGap close_loop(JointRotations& motion) {
  LoopGap gap;
  if (motion.frames < 2) return gap;
  const int last = motion.frames - 1;
  const int spread = std::min(
      last,
      std::max(1, std::min(last / 2, static_cast<int>(std::lround(kLongestSpread * motion.fps)))));
  gap.seconds = spread / motion.fps;
  const std::vector<double> headings = headings_of(motion);
  const double turned = headings.back() - headings.front();
  Vec3 shift = to_vec(motion.root.front()) - to_vec(motion.root.back());
  gap.travels = std::hypot(shift.x(), shift.z()) > kTravelled || std::abs(turned) > kTurned;
  if (gap.travels) shift.x() = shift.z() = 0;
  gap.metres = shift.norm();
  const Quat turn = motion::yaw_rotation(gap.travels ? turned : 0);
  for (int j = 0; j < motion.joints(); ++j) {
    Quat goal = to_quat(motion.rotation(0, j));
    if (motion.parents[static_cast<size_t>(j)] < 0) goal = turn * goal;
    const Quat change = to_quat(motion.rotation(last, j)).conjugate() * goal;
    gap.degrees = std::max(gap.degrees, Quat::Identity().angularDistance(change) * 180 / M_PI);
    for (int t = last - spread + 1; t <= last; ++t) {
      const double share = smooth(static_cast<double>(t - last + spread) / spread);
      const Quat now = to_quat(motion.rotation(t, j)) * Quat::Identity().slerp(share, change);
      const size_t at = static_cast<size_t>(t) * motion.parents.size() + static_cast<size_t>(j);
      motion.rotations[at] = from_quat(now.normalized());
    }
  }
  for (int t = last - spread + 1; t <= last; ++t) {
    const double share = smooth(static_cast<double>(t - last + spread) / spread);
    Vector3& root = motion.root[static_cast<size_t>(t)];
    root = from_vec(to_vec(root) + share * shift);
  }
  choose_signs(motion);
  return gap;
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
