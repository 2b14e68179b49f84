#include "kinematics/splice.h"
#include "motion/vector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinematics/foot_lock.h"
#include "kinematics/pose_fit.h"
#include "kinematics/splice_path.h"
#include "motion/rotation.h"
#include "remomask/error.h"

namespace remomask::kinematics {

namespace {

/// Makes a stretch begin, or end, with the value and the slope of the frames that stay: offset and
/// slope fade to zero (cubic Hermite).
struct EdgeOffset {
  Vec3 value = Vec3::Zero();  ///< at the frame that stays
  Vec3 slope = Vec3::Zero();  ///< per frame, away from it
  int fade = 0;

  /// `distance` frames from the frame that stays.
  Vec3 at(int distance) const {
    if (distance > fade) return Vec3::Zero();
    const double n = fade + 1, u = distance / n;
    return (2 * u * u * u - 3 * u * u + 1) * value + n * (u * u * u - 2 * u * u + u) * slope;
  }
};

class Splicer {
 public:
  Splicer(const Motion& original, const Motion& made, const motion::PartMask& mask,
          const Skeleton& skeleton, const SpliceOptions& options)
      : original_(original),
        mask_(mask),
        skeleton_(skeleton),
        options_(options),
        parts_(motion::joint_parts(skeleton)),
        lengths_(mean_bone_lengths(original, skeleton)),
        floor_(lowest_point(original)),
        placed_(place_beside(original, made, mask, skeleton, lengths_, floor_, report_)),
        result_(mask.frames(), skeleton.joints()),
        offsets_(static_cast<size_t>(mask.frames()) * skeleton.joints(), Vec3::Zero()) {}

  Motion splice(const Motion& made, SpliceReport* report) {
    for (int part = 0; part < motion::kBodyParts; ++part) {
      for (const motion::FrameRun& run : motion::part_runs(mask_, part)) add_offsets(part, run);
    }
    std::copy(original_.positions.begin(), original_.positions.end(), result_.positions.begin());
    for (int t = 0; t < mask_.frames(); ++t) {
      if (mask_.any(t)) fit_frame(t);
    }
    lock_feet(result_, made, floor_, mask_, skeleton_);
    if (report) *report = report_;
    return std::move(result_);
  }

 private:
  static double lowest_point(const Motion& motion) {
    double lowest = motion.positions[1];
    for (size_t i = 1; i < motion.positions.size(); i += 3) {
      lowest = std::min<double>(lowest, motion.positions[i]);
    }
    return lowest;
  }

  bool stays(int t, int joint) const { return !mask_.has(t, parts_[static_cast<size_t>(joint)]); }

  /// The bone that ends in the joint; of the root its height.
  static Vec3 bone(const Motion& motion, int t, int joint, int parent) {
    if (parent < 0) return {0, joint_position(motion, t, joint).y(), 0};
    return joint_position(motion, t, joint) - joint_position(motion, t, parent);
  }

  EdgeOffset edge_offset(int joint, int edge, int beyond, bool has_beyond, int fade) const {
    const int parent = skeleton_.parents[static_cast<size_t>(joint)];
    EdgeOffset offset;
    offset.fade = fade;
    offset.value = bone(original_, edge, joint, parent) - bone(placed_.motion, edge, joint, parent);
    if (!has_beyond) return offset;
    if (parent < 0) {
      // The path already meets the root's position; its speed is still to be fitted.
      const Vec3 step = placed_.root_steps[static_cast<size_t>(std::min(edge, beyond))];
      offset.slope = joint_position(original_, edge, 0) - joint_position(original_, beyond, 0) -
                     (beyond < edge ? step : Vec3(-step));
      return offset;
    }
    const auto change = [&](const Motion& motion) -> Vec3 {
      return bone(motion, edge, joint, parent) - bone(motion, beyond, joint, parent);
    };
    offset.slope = change(original_) - change(placed_.motion);
    return offset;
  }

  void add_offsets(int part, const motion::FrameRun& run) {
    const bool before = run.first > 0, after = run.last < original_.frames;
    const int length = run.last - run.first;
    const int fade = std::max(1, std::min(options_.fade, before && after ? length / 2 : length));
    for (int joint = 0; joint < skeleton_.joints(); ++joint) {
      if (parts_[static_cast<size_t>(joint)] != part) continue;
      if (before) {
        const int edge = run.first - 1;
        const bool more = edge > 0 && !mask_.has(edge - 1, part);
        const EdgeOffset offset = edge_offset(joint, edge, edge - 1, more, fade);
        for (int t = run.first; t < run.last; ++t) offset_at(t, joint) += offset.at(t - edge);
      }
      if (after) {
        const int edge = run.last;
        const bool more = edge + 1 < original_.frames && !mask_.has(edge + 1, part);
        const EdgeOffset offset = edge_offset(joint, edge, edge + 1, more, fade);
        for (int t = run.first; t < run.last; ++t) offset_at(t, joint) += offset.at(edge - t);
      }
    }
  }

  Vec3& offset_at(int t, int joint) {
    return offsets_[static_cast<size_t>(t) * skeleton_.joints() + joint];
  }

  void fit_frame(int t) {
    const int joints = skeleton_.joints();
    std::vector<Vec3> pose(static_cast<size_t>(joints)), target(pose.size());
    std::vector<bool> free(pose.size());
    for (int j = 0; j < joints; ++j) {
      const auto i = static_cast<size_t>(j);
      const int parent = skeleton_.parents[i];
      free[i] = !stays(t, j);
      pose[i] = t < original_.frames ? joint_position(original_, t, j)
                                     : joint_position(placed_.motion, t, j);
      if (!free[i]) {
        target[i] = pose[i];
      } else if (parent < 0) {
        target[i] = joint_position(placed_.motion, t, j) + offset_at(t, j);
      } else {
        target[i] = target[static_cast<size_t>(parent)] + bone(placed_.motion, t, j, parent) +
                    offset_at(t, j);
      }
    }
    fit_free_joints(pose, target, free, lengths_, skeleton_);
    for (int j = 0; j < joints; ++j) {
      if (free[static_cast<size_t>(j)])
        set_joint_position(result_, t, j, pose[static_cast<size_t>(j)]);
    }
  }

  const Motion& original_;
  const motion::PartMask& mask_;
  const Skeleton& skeleton_;
  SpliceOptions options_;
  std::vector<int> parts_;
  std::vector<double> lengths_;
  double floor_;
  SpliceReport report_;
  PlacedMotion placed_;
  Motion result_;
  std::vector<Vec3> offsets_;  ///< [frames][joints], added to the bones of `placed_`
};

}  // namespace

Motion splice_motion(const Motion& original, const Motion& made, const motion::PartMask& mask,
                     const Skeleton& skeleton, const SpliceOptions& options, SpliceReport* report) {
  if (original.joints != skeleton.joints() || made.joints != skeleton.joints() ||
      original.frames < 1 || original.frames > mask.frames() || made.frames != mask.frames()) {
    throw Error(fmt::format(
        "the motions to splice have {} and {} frames and the mask has {}; they do not fit "
        "together",
        original.frames, made.frames, mask.frames()));
  }
  for (int t = original.frames; t < mask.frames(); ++t) {
    if (!mask.whole(t))
      throw Error("frames after the end of the original motion must be new as a whole");
  }
  return Splicer(original, made, mask, skeleton, options).splice(made, report);
}

}  // namespace remomask::kinematics
