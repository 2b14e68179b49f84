#include "rig/loop.h"

#include <algorithm>
#include <cmath>

#include "motion/rotation.h"
#include "remomask/skeleton.h"
#include "rig/forward_kinematics.h"
#include "rig/leg_pose.h"
#include "rig/root_motion.h"

namespace remomask::rig {

namespace {

constexpr double kLongestSpread = 1;                   // s
constexpr double kTravelled = 0.3, kTurned = 0.5;      // m, rad
constexpr double kStepped = 0.01;                      // m; a shorter way is slid
constexpr double kStandingHeight = 0.08;               // m, of the toe
constexpr double kFarthestShift = 0.2;                 // m in a second
constexpr double kShortestSwing = 0.14;                // s
constexpr double kStepTime = 0.4, kStepHeight = 0.06;  // s, m

double smooth(double share) { return share * share * (3 - 2 * share); }

/// An ankle and its toe in one frame, and how the foot is turned.
struct Foot {
  Vec3 ankle, toe;
  Quat turn;
};

Foot foot_of(const WorldPose& pose, size_t side) {
  const Skeleton& skeleton = humanml_skeleton();
  const std::vector<int>& feet = side == 0 ? skeleton.left_feet : skeleton.right_feet;
  const auto ankle = static_cast<size_t>(feet.front()), toe = static_cast<size_t>(feet.back());
  return {pose.positions[ankle], pose.positions[toe], pose.rotations[ankle]};
}

class LoopCloser {
 public:
  explicit LoopCloser(JointRotations& motion)
      : motion_(motion),
        last_(motion.frames - 1),
        spread_(std::min(
            last_, std::max(1, std::min(last_ / 2, static_cast<int>(std::lround(kLongestSpread *
                                                                                motion.fps)))))) {
    for (int t = last_ - spread_; t <= last_; ++t) {
      const WorldPose pose = world_pose(motion, t);
      for (size_t side = 0; side < 2; ++side) feet_[side].push_back(foot_of(pose, side));
    }
  }

  LoopGap close() {
    LoopGap gap;
    gap.seconds = spread_ / motion_.fps;
    const std::vector<double> headings = headings_of(motion_);
    const double turned = headings.back() - headings.front();
    Vec3 shift = to_vec(motion_.root.front()) - to_vec(motion_.root.back());
    gap.travels = std::hypot(shift.x(), shift.z()) > kTravelled || std::abs(turned) > kTurned;
    const Quat turn = motion::yaw_rotation(gap.travels ? turned : 0);
    if (gap.travels) shift.x() = shift.z() = 0;
    gap.metres = shift.norm();
    if (gap.travels) shift += towards_standing_feet(turn);
    gap.degrees = blend_rotations(turn);
    for (int t = last_ - spread_ + 1; t <= last_; ++t) {
      Vector3& root = motion_.root[static_cast<size_t>(t)];
      root = from_vec(to_vec(root) + share_of(t) * shift);
    }
    for (size_t side = 0; side < 2; ++side) plant(side);
    choose_signs(motion_);
    return gap;
  }

 private:
  double share_of(int frame) const {
    return smooth(static_cast<double>(frame - last_ + spread_) / spread_);
  }
  /// Whether the foot stands on the way into frame `i` of the stretch, before it was changed.
  bool stands(size_t side, size_t i) const {
    return stands_between(feet_[side][i - 1], feet_[side][i]);
  }
  bool stands_between(const Foot& before, const Foot& now) const {
    const double way = std::min((now.ankle - before.ankle).norm(), (now.toe - before.toe).norm());
    return now.toe.y() < kStandingHeight && way * motion_.fps < kStandingSpeed;
  }

  /// Over the ground, from where the last frame's feet would be to where they stand, for those that
  /// stand at both ends of the motion.
  Vec3 towards_standing_feet(const Quat& turn) const {
    const WorldPose first = world_pose(motion_, 0), second = world_pose(motion_, 1);
    const Vec3 end = to_vec(motion_.root.back());
    Vec3 sum = Vec3::Zero();
    int standing = 0;
    for (size_t side = 0; side < 2; ++side) {
      const Foot begins = foot_of(first, side);
      if (!stands_between(foot_of(second, side), begins) || !stands(side, feet_[side].size() - 1)) {
        continue;
      }
      sum += feet_[side].back().toe - (end + turn * (begins.toe - first.positions[0]));
      ++standing;
    }
    if (standing == 0) return Vec3::Zero();
    sum.y() = 0;
    const Vec3 shift = sum / standing;
    return shift * std::min(1.0, kFarthestShift / std::max(shift.norm(), 1e-9));
  }

  /// The largest angle that a joint is turned by.
  double blend_rotations(const Quat& turn) {
    double degrees = 0;
    for (int j = 0; j < motion_.joints(); ++j) {
      Quat goal = to_quat(motion_.rotation(0, j));
      if (motion_.parents[static_cast<size_t>(j)] < 0) goal = turn * goal;
      const Quat change = to_quat(motion_.rotation(last_, j)).conjugate() * goal;
      degrees = std::max(degrees, Quat::Identity().angularDistance(change) * 180 / M_PI);
      for (int t = last_ - spread_ + 1; t <= last_; ++t) {
        const Quat now =
            to_quat(motion_.rotation(t, j)) * Quat::Identity().slerp(share_of(t), change);
        const size_t at = static_cast<size_t>(t) * motion_.parents.size() + static_cast<size_t>(j);
        motion_.rotations[at] = from_quat(now.normalized());
      }
    }
    return degrees;
  }

  /// How much of its change a foot has made in each frame of the stretch: it changes while it
  /// swings; one that stands all the time makes a step, the left one before the right one.
  std::vector<double> shares(size_t side, double way, std::vector<double>& lifts) const {
    const size_t count = feet_[side].size();
    std::vector<double> shares(count, 0);
    lifts.assign(count, 0);
    double swings = 0;
    int frames = 0;
    for (size_t i = 1; i < count; ++i) {
      const double inside =
          std::sin(M_PI * (static_cast<double>(i) - 0.5) / static_cast<double>(count - 1));
      if (!stands(side, i)) {
        swings += inside;
        ++frames;
      }
      shares[i] = swings;
    }
    if (frames > kShortestSwing * motion_.fps) {
      for (double& share : shares) share /= swings;
      return shares;
    }
    const double end = static_cast<double>(count - 1);
    const double step = std::min(kStepTime * motion_.fps, 0.5 * end);
    const double first = side == 0 ? 0.25 * end - 0.5 * step : 0.75 * end - 0.5 * step;
    for (size_t i = 1; i < count; ++i) {
      const double at = std::clamp((static_cast<double>(i) - first) / step, 0.0, 1.0);
      shares[i] = way > kStepped ? smooth(at) : share_of(last_ - spread_ + static_cast<int>(i));
      if (way > kStepped) lifts[i] = kStepHeight * std::sin(M_PI * at);
    }
    shares[count - 1] = 1;
    return shares;
  }

  /// Leads the foot from where it was to where the last frame has it.
  void plant(size_t side) {
    const Skeleton& skeleton = humanml_skeleton();
    const std::vector<int>& joints = side == 0 ? skeleton.left_feet : skeleton.right_feet;
    const Foot goal = foot_of(world_pose(motion_, last_), side), &was = feet_[side].back();
    const Vec3 change = goal.ankle - was.ankle;
    const Quat turn = was.turn.conjugate() * goal.turn;
    std::vector<double> lifts;
    const std::vector<double> share = shares(side, change.norm(), lifts);
    for (int i = 1; i < spread_; ++i) {
      const auto at = static_cast<size_t>(i);
      const Foot& foot = feet_[side][at];
      const Vec3 target = foot.ankle + share[at] * change + lifts[at] * Vec3::UnitY();
      const Quat turned = foot.turn * Quat::Identity().slerp(share[at], turn);
      put_foot(motion_, last_ - spread_ + i, static_cast<size_t>(joints.front()),
               turned.normalized(), target);
    }
  }

  JointRotations& motion_;
  int last_, spread_;
  std::array<std::vector<Foot>, 2> feet_;  ///< before the change, from the frame before the stretch
};

}  // namespace

LoopGap close_loop(JointRotations& motion) {
  return motion.frames < 2 ? LoopGap{} : LoopCloser(motion).close();
}

}  // namespace remomask::rig
