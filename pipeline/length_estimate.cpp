#include "pipeline/length_estimate.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/time.h"
#include "generator/ssta.h"
#include "remomask/error.h"

namespace remomask::pipeline {

namespace {

constexpr auto kMinTokens = static_cast<int64_t>(kMinMotionSeconds * kFps) / kFramesPerToken;
constexpr double kLikenessScale = 0.1, kTokenSeconds = 0.2;
constexpr uint64_t kLengthStream = 0x6c656e67;

}  // namespace

const char* length_rule_name(LengthRule rule) {
  switch (rule) {
    case LengthRule::evidence:
      return "evidence";
    case LengthRule::likely:
      return "likely";
    case LengthRule::sample:
      return "sample";
  }
  return "";
}

std::vector<double> length_distribution(const std::vector<LengthNeighbour>& neighbours) {
  std::vector<double> result(kMaxTokenFrames + 1, 0);
  double best = -1;
  for (const auto& neighbour : neighbours) {
    if (neighbour.frames > 0) best = std::max(best, neighbour.likeness);
  }
  for (const auto& neighbour : neighbours) {
    if (neighbour.frames <= 0) continue;
    const double weight = std::exp((neighbour.likeness - best) / kLikenessScale);
    const int64_t tokens = std::clamp<int64_t>(
        (neighbour.frames + kFramesPerToken / 2) / kFramesPerToken, kMinTokens, kMaxTokenFrames);
    for (int64_t offset = -2; offset <= 2; ++offset) {
      const int64_t length = tokens + offset;
      if (length < kMinTokens || length > kMaxTokenFrames) continue;
      result[static_cast<size_t>(length)] += weight * static_cast<double>(3 - std::abs(offset));
    }
  }
  double sum = 0;
  for (const double value : result) sum += value;
  if (sum == 0) std::fill(result.begin() + kMinTokens, result.end(), 1.0);
  if (sum == 0) sum = static_cast<double>(kMaxTokenFrames + 1 - kMinTokens);
  for (double& value : result) value /= sum;
  return result;
}

double estimate_seconds(const std::vector<double>& distribution, LengthRule rule, uint64_t seed) {
  if (rule == LengthRule::evidence) {
    throw Error("the length of the evidence is not that of a distribution");
  }
  auto chosen = std::max_element(distribution.begin(), distribution.end());
  if (rule == LengthRule::sample) {
    double left = CounterRandom(seed, kLengthStream).uniform_at(0);
    auto place = distribution.begin();
    for (; place != distribution.end(); ++place) {
      if (*place > 0) chosen = place;
      left -= *place;
      if (left < 0) break;
    }
  }
  return kTokenSeconds * static_cast<double>(chosen - distribution.begin());
}

}  // namespace remomask::pipeline
