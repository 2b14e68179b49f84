#include "pipeline/draft.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.h"

namespace remomask::pipeline {

namespace {

constexpr double kLengthWeight = 0.1, kEqualScores = 0.03;
constexpr int kLeastDraftFrames = 8;
constexpr double kMostStretch = 1.25;
constexpr uint64_t kChoiceStream = 0x64726166, kFramesStream = 0x6672616d;

/// Frame `t` of the result is frame t (n - 1) / (frames - 1) of the motion, linearly.
Motion resample(const Motion& motion, int frames) {
  Motion result(frames, motion.joints);
  for (int t = 0; t < frames; ++t) {
    const double place =
        frames > 1 ? t * static_cast<double>(motion.frames - 1) / (frames - 1) : 0.0;
    const int before = std::min(static_cast<int>(place), motion.frames - 1);
    const int after = std::min(before + 1, motion.frames - 1);
    const double share = place - before;
    for (int joint = 0; joint < motion.joints; ++joint) {
      set_joint_position(result, t, joint,
                         (1 - share) * joint_position(motion, before, joint) +
                             share * joint_position(motion, after, joint));
    }
  }
  return result;
}

/// First frame of the stretch in which the joints travel furthest; the earliest of equal ones.
int liveliest_start(const Motion& motion, int frames) {
  std::vector<double> travelled(static_cast<size_t>(motion.frames), 0);
  for (int t = 1; t < motion.frames; ++t) {
    double step = 0;
    for (int joint = 0; joint < motion.joints; ++joint) {
      step += (joint_position(motion, t, joint) - joint_position(motion, t - 1, joint)).norm();
    }
    travelled[static_cast<size_t>(t)] = travelled[static_cast<size_t>(t) - 1] + step;
  }
  int best = 0;
  double most = -1;
  for (int start = 0; start + frames <= motion.frames; ++start) {
    const double distance =
        travelled[static_cast<size_t>(start + frames) - 1] - travelled[static_cast<size_t>(start)];
    if (distance > most + 1e-9) {
      most = distance;
      best = start;
    }
  }
  return best;
}

}  // namespace

std::optional<size_t> choose_draft(const std::vector<DraftCandidate>& candidates, int frames,
                                   uint64_t seed) {
  std::vector<std::pair<double, size_t>> scored;
  double best = -2;
  for (size_t i = 0; i < candidates.size(); ++i) {
    const int length = candidates[i].frames;
    if (length < kLeastDraftFrames) continue;
    const double apart = std::abs(length - frames) / static_cast<double>(std::max(length, frames));
    const double score = candidates[i].similarity * std::exp(-kLengthWeight * apart);
    scored.emplace_back(score, i);
    best = std::max(best, score);
  }
  std::erase_if(scored, [&](const auto& entry) { return entry.first < best - kEqualScores; });
  if (scored.empty()) return std::nullopt;
  CounterRandom random(seed, kChoiceStream);
  return scored[random.below(scored.size())].second;
}

Motion fit_length(const Motion& motion, int frames) {
  const double ratio = static_cast<double>(motion.frames) / frames;
  if (ratio <= kMostStretch && ratio >= 1 / kMostStretch) return resample(motion, frames);
  if (motion.frames < frames) return motion;
  const int start = liveliest_start(motion, frames);
  return slice(motion, start, start + frames);
}

std::vector<bool> followed_frames(int64_t frames, double share, uint64_t seed) {
  const double start = CounterRandom(seed, kFramesStream).uniform_at(0);
  std::vector<std::pair<double, size_t>> order;
  for (int64_t t = 0; t < frames; ++t) {
    const double place = start + static_cast<double>(t) / std::numbers::phi;
    order.emplace_back(place - std::floor(place), static_cast<size_t>(t));
  }
  std::sort(order.begin(), order.end());
  const auto kept =
      static_cast<size_t>(std::llround(std::clamp(share, 0.0, 1.0) * static_cast<double>(frames)));
  std::vector<bool> result(static_cast<size_t>(frames), false);
  for (size_t i = 0; i < kept; ++i) result[order[i].second] = true;
  return result;
}

}  // namespace remomask::pipeline
