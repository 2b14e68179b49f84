#include "kinematics/splice_path.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "motion/rotation.h"

namespace remomask::kinematics {

namespace {

constexpr double kIdleSpeed = 0.05;  // m/s, so that even a path that stands can be bent
constexpr int kPathRamp = 6;         // frames over which the bending begins and ends

/// Where a frame of the made motion goes: turned about its root, with the root at `root`.
struct Placement {
  double yaw = 0;
  Vec3 root = Vec3::Zero();
};

class PathPlacer {
 public:
  PathPlacer(const Motion& original, const Motion& made, const motion::PartMask& mask,
             const Skeleton& skeleton, double scale, double floor)
      : original_(original),
        made_(made),
        mask_(mask),
        skeleton_(skeleton),
        parts_(motion::joint_parts(skeleton)),
        scale_(scale),
        floor_(floor),
        placements_(static_cast<size_t>(mask.frames())) {}

  std::vector<Placement> place(SpliceReport& report) {
    for (int t = 0; t < mask_.frames(); ++t) {
      if (!mask_.whole(t)) at(t) = beside_what_stays(t);
    }
    for (const motion::FrameRun& run : motion::part_runs(mask_, parts_[0])) shift_new_roots(run);
    for (const motion::FrameRun& run : motion::whole_runs(mask_)) {
      const bool before = run.first > 0, after = run.last < mask_.frames();
      if (before && after) {
        bend(run, report);
      } else if (after) {
        for (int t = run.last - 1; t >= run.first; --t) at(t) = step(t + 1, t, at(t + 1).yaw);
      } else {
        if (!before) at(run.first) = first_placement();
        for (int t = std::max(1, run.first); t < run.last; ++t) {
          at(t) = step(t - 1, t, at(t - 1).yaw);
        }
      }
    }
    return placements_;
  }

 private:
  Placement& at(int t) { return placements_[static_cast<size_t>(t)]; }

  /// Heading of a pose by its hips and shoulders, as far as both sides count.
  template <class Counts>
  double facing(const Motion& motion, int t, const Counts& counts) const {
    Vec3 across = Vec3::Zero();
    for (const auto& [right, left] :
         {std::pair(skeleton_.right_hip, skeleton_.left_hip),
          std::pair(skeleton_.right_shoulder, skeleton_.left_shoulder)}) {
      if (counts(right) && counts(left)) {
        across += joint_position(motion, t, right) - joint_position(motion, t, left);
      }
    }
    const Vec3 forward = Vec3::UnitY().cross(across);
    return std::atan2(forward.x(), forward.z());
  }

  /// Lays the made pose on the joints that count: same heading, same centre.
  template <class Counts>
  Placement fit(int t, const Counts& counts) const {
    Vec3 here = Vec3::Zero(), there = Vec3::Zero();
    int count = 0;
    for (int j = 0; j < skeleton_.joints(); ++j) {
      if (!counts(j)) continue;
      here += joint_position(original_, t, j);
      there += scale_ * joint_position(made_, t, j);
      ++count;
    }
    here /= count;
    there /= count;
    const bool hips = counts(skeleton_.right_hip) && counts(skeleton_.left_hip);
    const bool shoulders = counts(skeleton_.right_shoulder) && counts(skeleton_.left_shoulder);
    const auto both_sides = [&](int j) { return hips || shoulders ? counts(j) : true; };
    Placement result;
    result.yaw = facing(original_, t, both_sides) - facing(made_, t, both_sides);
    result.root =
        here + motion::yaw_rotation(result.yaw) * (scale_ * joint_position(made_, t, 0) - there);
    return result;
  }

  double made_height(int t) const { return floor_ + scale_ * joint_position(made_, t, 0).y(); }

  Placement fit_to_what_stays(int t) const {
    return fit(t, [&](int j) { return !mask_.has(t, parts_[static_cast<size_t>(j)]); });
  }

  Placement beside_what_stays(int t) const {
    Placement result = fit_to_what_stays(t);
    if (!mask_.has(t, parts_[0])) result.root = joint_position(original_, t, 0);
    result.root.y() = made_height(t);
    return result;
  }

  /// Where the root is new and other parts stay, its position is fitted; at the ends of the stretch
  /// it must be where the original's root is.
  void shift_new_roots(const motion::FrameRun& run) {
    const auto miss = [&](int t) -> Vec3 {
      if (t < 0 || t >= original_.frames) return Vec3::Zero();
      const Vec3 shift = joint_position(original_, t, 0) - fit_to_what_stays(t).root;
      return {shift.x(), 0, shift.z()};
    };
    const Vec3 begin = miss(run.first - 1), end = miss(run.last);
    for (int t = run.first; t < run.last; ++t) {
      if (mask_.whole(t)) continue;
      const double u = (t - run.first + 1.0) / (run.last - run.first + 1.0);
      at(t).root += begin + u * (end - begin);
    }
  }

  Placement first_placement() const {
    Placement result = fit(0, [](int) { return true; });
    result.root = joint_position(original_, 0, 0);
    result.root.y() = made_height(0);
    return result;
  }

  /// The placement of `to` from that of its neighbour `from`, with the step turned by `yaw`.
  Placement step(int from, int to, double yaw) const {
    Placement result;
    result.yaw = yaw;
    result.root = placements_[static_cast<size_t>(from)].root +
                  motion::yaw_rotation(yaw) *
                      (scale_ * (joint_position(made_, to, 0) - joint_position(made_, from, 0)));
    result.root.y() = made_height(to);
    return result;
  }

  /// Share of a bend that is done when frame first-1+i is reached, i = 0 .. n: large where the path
  /// moves, small at both ends.
  std::vector<double> progress(const motion::FrameRun& run) const {
    const int steps = run.last - run.first + 1;
    std::vector<double> share(static_cast<size_t>(steps) + 1, 0);
    const double ramp = std::max(1.0, std::min<double>(kPathRamp, steps / 3.0));
    for (int i = 0; i < steps; ++i) {
      const int t = run.first + i;
      const Vec3 way = joint_position(made_, t, 0) - joint_position(made_, t - 1, 0);
      const double speed = std::hypot(way.x(), way.z()) * skeleton_.fps + kIdleSpeed;
      const double edge = std::min({1.0, (i + 0.5) / ramp, (steps - i - 0.5) / ramp});
      share[static_cast<size_t>(i) + 1] = share[static_cast<size_t>(i)] + speed * edge;
    }
    for (double& value : share) value /= share.back();
    return share;
  }

  /// Bends path and heading between two ends: first the heading, then the remaining distance.
  void bend(const motion::FrameRun& run, SpliceReport& report) {
    const std::vector<double> share = progress(run);
    const Placement begin = at(run.first - 1), end = at(run.last);
    const double turn = std::remainder(end.yaw - begin.yaw, 2 * std::numbers::pi);
    const auto done = [&](int t) { return share[static_cast<size_t>(t - run.first) + 1]; };
    for (int t = run.first; t <= run.last; ++t) {
      at(t) = step(t - 1, t, begin.yaw + turn * (done(t) + done(t - 1)) / 2);
    }
    Vec3 miss = end.root - at(run.last).root;
    miss.y() = 0;
    for (int t = run.first; t < run.last; ++t) {
      at(t).root += done(t) * miss;
      at(t).yaw = begin.yaw + turn * done(t);
    }
    at(run.last) = end;
    report.path_shift = std::max(report.path_shift, miss.norm());
    report.path_turn = std::max(report.path_turn, std::abs(turn));
  }

  const Motion& original_;
  const Motion& made_;
  const motion::PartMask& mask_;
  const Skeleton& skeleton_;
  std::vector<int> parts_;
  double scale_, floor_;
  std::vector<Placement> placements_;
};

}  // namespace

PlacedMotion place_beside(const Motion& original, const Motion& made, const motion::PartMask& mask,
                          const Skeleton& skeleton, const std::vector<double>& lengths,
                          double floor, SpliceReport& report) {
  const auto leg = [&](const std::vector<double>& bones) {
    return bones[static_cast<size_t>(skeleton.leg_upper)] +
           bones[static_cast<size_t>(skeleton.leg_lower)];
  };
  const double scale = leg(lengths) / leg(skeleton.bone_lengths);
  const std::vector<Placement> placements =
      PathPlacer(original, made, mask, skeleton, scale, floor).place(report);
  PlacedMotion result{Motion(made.frames, made.joints), {}};
  for (int t = 0; t < made.frames; ++t) {
    const Placement& placement = placements[static_cast<size_t>(t)];
    const Eigen::Matrix3d turn = motion::yaw_rotation(placement.yaw).toRotationMatrix();
    const int next = std::min(t + 1, made.frames - 1);
    result.root_steps.push_back(
        turn * (scale * (joint_position(made, next, 0) - joint_position(made, t, 0))));
    for (int j = 0; j < made.joints; ++j) {
      set_joint_position(result.motion, t, j,
                         placement.root + turn * (scale * (joint_position(made, t, j) -
                                                           joint_position(made, t, 0))));
    }
  }
  return result;
}

}  // namespace remomask::kinematics
