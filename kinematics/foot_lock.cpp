#include "kinematics/foot_lock.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>

#include "kinematics/leg.h"

namespace remomask::kinematics {

namespace {

/// Weight 1 at a corrected frame, 0 at `fade + 1` frames from it.
double fade_weight(int distance, int fade) {
  const double u = std::clamp(1 - static_cast<double>(distance) / (fade + 1), 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

/// Whether the toe stands between frames t and t + 1 (t - 1 and t at the end).
bool stands(const Motion& motion, int t, int toe, double floor, double fps,
            const FootLockOptions& options) {
  if (motion.frames < 2) return false;
  const int a = std::min(t, motion.frames - 2);
  const Vec3 here = joint_position(motion, t, toe);
  const Vec3 step = joint_position(motion, a + 1, toe) - joint_position(motion, a, toe);
  return here.y() - floor < options.height && std::hypot(step.x(), step.z()) * fps < options.speed;
}

class LegLock {
 public:
  LegLock(Motion& motion, const Motion& guide, double floor, const Leg& leg, double fps,
          const FootLockOptions& options)
      : motion_(motion), guide_(guide), floor_(floor), leg_(leg), fps_(fps), options_(options) {}

  /// Corrects frames [run.first, run.last).
  void correct(const motion::FrameRun& run) {
    const std::vector<Vec3> shifts = shifts_of(run);
    for (int t = run.first; t < run.last; ++t) {
      Vec3 shift = shifts[static_cast<size_t>(t - run.first)];
      const double lowest =
          std::min(motion_.at(t, leg_.toe)[1], motion_.at(t, leg_.ankle)[1]) + shift.y();
      shift.y() += std::max(0.0, floor_ - lowest);
      if (shift.norm() >= 1e-6) move_foot(motion_, t, leg_, shift);
    }
  }

 private:
  std::vector<motion::FrameRun> steps_in(const motion::FrameRun& run) const {
    std::vector<motion::FrameRun> steps;
    for (int t = run.first; t < run.last; ++t) {
      if (!stands(guide_, t, leg_.toe, 0, fps_, options_)) continue;
      if (steps.empty() || steps.back().last != t) steps.push_back({t, t});
      steps.back().last = t + 1;
    }
    return steps;
  }

  /// How far each standing frame is moved over the ground, and the fades.
  std::vector<Vec3> shifts_of(const motion::FrameRun& run) const {
    const auto count = static_cast<size_t>(run.last - run.first);
    std::vector<Vec3> shifts(count, Vec3::Zero());
    std::vector<double> weights(count, 0);
    for (const motion::FrameRun& step : steps_in(run)) {
      const bool from_before = step.first == run.first && run.first > 0 &&
                               stands(motion_, run.first - 1, leg_.toe, floor_, fps_, options_);
      const bool to_after = step.last == run.last && run.last < motion_.frames &&
                            stands(motion_, run.last, leg_.toe, floor_, fps_, options_);
      const Vec3 middle = joint_position(motion_, (step.first + step.last) / 2, leg_.toe);
      const Vec3 begin = from_before ? joint_position(motion_, run.first - 1, leg_.toe) : middle;
      const Vec3 end = to_after ? joint_position(motion_, run.last, leg_.toe) : middle;
      const auto shift_at = [&](int t) -> Vec3 {
        const double u = (t - step.first + 1.0) / (step.last - step.first + 1.0);
        Vec3 place = from_before && !to_after   ? begin
                     : to_after && !from_before ? end
                                                : Vec3(begin + u * (end - begin));
        place -= joint_position(motion_, t, leg_.toe);
        place.y() = 0;
        return place;
      };
      // Outside the step, its nearer end fades out.
      for (int t = std::max(run.first, step.first - options_.fade);
           t < std::min(run.last, step.last + options_.fade); ++t) {
        const int nearest = std::clamp(t, step.first, step.last - 1);
        const double weight = fade_weight(std::abs(t - nearest), options_.fade);
        // Next to frames that stay, other corrections start from zero.
        const double first =
            from_before || run.first == 0 ? 1 : 1 - fade_weight(t - run.first + 1, options_.fade);
        const double last = to_after || run.last == motion_.frames
                                ? 1
                                : 1 - fade_weight(run.last - t, options_.fade);
        const auto i = static_cast<size_t>(t - run.first);
        // Where the fades of two steps meet, each counts by its weight.
        shifts[i] += weight * weight * first * last * shift_at(nearest);
        weights[i] += weight;
      }
    }
    for (size_t i = 0; i < count; ++i) {
      if (weights[i] > 0) shifts[i] /= weights[i];
    }
    return shifts;
  }

  Motion& motion_;
  const Motion& guide_;
  double floor_;
  Leg leg_;
  double fps_;
  FootLockOptions options_;
};

}  // namespace

void lock_feet(Motion& motion, const Motion& guide, double floor, const motion::PartMask& mask,
               const Skeleton& skeleton, const FootLockOptions& options) {
  const std::vector<int> parts = motion::joint_parts(skeleton);
  for (const auto* feet : {&skeleton.left_feet, &skeleton.right_feet}) {
    for (const motion::FrameRun& run :
         motion::part_runs(mask, parts[static_cast<size_t>(feet->back())])) {
      const Leg leg = leg_of(*feet, skeleton, motion, run.first);
      LegLock(motion, guide, floor, leg, skeleton.fps, options).correct(run);
    }
  }
}

}  // namespace remomask::kinematics
