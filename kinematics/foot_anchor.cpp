#include "kinematics/foot_anchor.h"
#include "motion/vector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "remomask/error.h"

namespace remomask::kinematics {

namespace {

constexpr int kLongestGap = 1, kShortestContact = 3;

/// Inverts runs of `value` of at most `longest` frames; with `keep_ends`, runs at the ends stay.
void turn_short_runs(FootContacts& contacts, size_t foot, bool value, int longest, bool keep_ends) {
  const int frames = static_cast<int>(contacts.size());
  for (int first = 0; first < frames;) {
    int last = first;
    while (last < frames && contacts[static_cast<size_t>(last)][foot] == value) ++last;
    const bool at_end = first == 0 || last == frames;
    if (last > first && last - first <= longest && !(keep_ends && at_end)) {
      for (int t = first; t < last; ++t) contacts[static_cast<size_t>(t)][foot] = !value;
    }
    first = std::max(last, first + 1);
  }
}

}  // namespace

FootContacts read_contacts(const motion::Features& features, const Skeleton& skeleton) {
  if (features.dim != skeleton.feature_dim()) {
    throw Error(fmt::format("features of {} columns do not fit the skeleton \"{}\", which has {}",
                            features.dim, skeleton.name, skeleton.feature_dim()));
  }
  FootContacts contacts(static_cast<size_t>(features.frames));
  for (int t = 0; t < features.frames; ++t) {
    // The last four columns: left ankle, left toe, right ankle, right toe.
    const float* last = features.row(t) + features.dim;
    contacts[static_cast<size_t>(t)] = {last[-3] > 0.5f, last[-1] > 0.5f};
  }
  for (const size_t foot : {0u, 1u}) {
    turn_short_runs(contacts, foot, false, kLongestGap, true);
    turn_short_runs(contacts, foot, true, kShortestContact - 1, true);
  }
  return contacts;
}

void anchor_to_feet(Motion& motion, const FootContacts& contacts, const Skeleton& skeleton,
                    double fastest) {
  if (static_cast<int>(contacts.size()) != motion.frames) {
    throw Error(fmt::format("there are contacts for {} frames, the motion has {}", contacts.size(),
                            motion.frames));
  }
  const std::array<int, 2> toes = {skeleton.left_feet.back(), skeleton.right_feet.back()};
  const auto frames = static_cast<size_t>(motion.frames);
  std::vector<Vec3> slides(frames, Vec3::Zero());  // of the step that ends in the frame
  for (int t = 1; t < motion.frames; ++t) {
    int standing = 0;
    Vec3 sum = Vec3::Zero();
    for (const size_t foot : {0u, 1u}) {
      if (!contacts[static_cast<size_t>(t - 1)][foot] || !contacts[static_cast<size_t>(t)][foot]) {
        continue;
      }
      Vec3 step = joint_position(motion, t, toes[foot]) - joint_position(motion, t - 1, toes[foot]);
      step.y() = 0;
      const double speed = step.norm() * skeleton.fps;
      sum += std::clamp(2 * (1 - speed / fastest), 0.0, 1.0) * step;
      ++standing;
    }
    if (standing > 0) slides[static_cast<size_t>(t)] = sum / standing;
  }
  Vec3 shift = Vec3::Zero();
  for (size_t t = 1; t < frames; ++t) {
    const Vec3& before = slides[t == 1 ? 1 : t - 1];
    const Vec3& after = slides[t + 1 == frames ? t : t + 1];
    shift -= 0.25 * before + 0.5 * slides[t] + 0.25 * after;
    for (int joint = 0; joint < motion.joints; ++joint) {
      set_joint_position(motion, static_cast<int>(t), joint,
                         joint_position(motion, static_cast<int>(t), joint) + shift);
    }
  }
}

}  // namespace remomask::kinematics
