#include "rig/resample_rotations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "remomask/error.h"
#include "remomask/skeleton.h"
#include "rig/forward_kinematics.h"
#include "rig/leg_pose.h"

namespace remomask::rig {

namespace {

constexpr double kLowestFps = 1, kHighestFps = 240;

class Resampler {
 public:
  Resampler(const JointRotations& source, double fps) : source_(source) {
    result_ = source;
    result_.fps = fps;
    result_.root.clear();
    result_.rotations.clear();
  }

  JointRotations resample() {
    const double seconds = (source_.frames - 1) / source_.fps;
    // The small addition keeps the last frame of motions whose length is a whole number of frames
    // up to rounding.
    result_.frames = static_cast<int>(seconds * result_.fps + 1e-3) + 1;
    for (int t = 0; t < result_.frames; ++t) {
      const double at = std::min(t / result_.fps * source_.fps, source_.frames - 1.0);
      const int before = std::min(static_cast<int>(at), source_.frames - 2);
      add_frame(before, at - before);
    }
    choose_signs(result_);
    return std::move(result_);
  }

 private:
  void add_frame(int before, double share) {
    if (before != before_) {
      before_ = before;
      here_ = world_pose(source_, before);
      next_ = world_pose(source_, before + 1);
    }
    const auto at = static_cast<size_t>(before);
    result_.root.push_back(
        from_vec((1 - share) * to_vec(source_.root[at]) + share * to_vec(source_.root[at + 1])));
    for (int j = 0; j < source_.joints(); ++j) {
      result_.rotations.push_back(
          from_quat(to_quat(source_.rotation(before, j))
                        .slerp(share, to_quat(source_.rotation(before + 1, j)))
                        .normalized()));
    }
    if (share <= 1e-9 || share >= 1 - 1e-9) return;
    const Skeleton& skeleton = humanml_skeleton();
    for (const auto* feet : {&skeleton.left_feet, &skeleton.right_feet}) {
      hold_foot(static_cast<size_t>(feet->front()), static_cast<size_t>(feet->back()), share);
    }
  }

  /// Both frames around have the foot where it is meant to be. What stands between them goes
  /// straight from one to the other, and so stays.
  void hold_foot(size_t ankle, size_t toe, double share) {
    const double toe_way = (next_.positions[toe] - here_.positions[toe]).norm();
    const double ankle_way = (next_.positions[ankle] - here_.positions[ankle]).norm();
    if (std::min(toe_way, ankle_way) * source_.fps > kStandingSpeed) return;
    const Quat foot = here_.rotations[ankle].slerp(share, next_.rotations[ankle]).normalized();
    const size_t held = toe_way <= ankle_way ? toe : ankle;
    Vec3 target = (1 - share) * here_.positions[held] + share * next_.positions[held];
    if (held == toe) target -= foot * to_vec(source_.rest_offsets[toe]);
    put_foot(result_, static_cast<int>(result_.root.size()) - 1, ankle, foot, target);
  }

  const JointRotations& source_;
  JointRotations result_;
  int before_ = -1;
  WorldPose here_, next_;
};

}  // namespace

JointRotations resample_rotations(const JointRotations& motion, double fps) {
  if (!(fps >= kLowestFps && fps <= kHighestFps)) {
    throw Error(fmt::format("a motion is written at {:g} to {:g} frames a second, not at {:g}",
                            kLowestFps, kHighestFps, fps));
  }
  if (motion.frames < 2 || fps == motion.fps) {
    JointRotations same = motion;
    same.fps = fps;
    return same;
  }
  return Resampler(motion, fps).resample();
}

}  // namespace remomask::rig
