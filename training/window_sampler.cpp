#include "training/window_sampler.h"

#include <torch/types.h>

#include <algorithm>
#include <map>

#include "base/random.h"
#include "remomask/error.h"
#include "tokenizer/length_batches.h"

namespace remomask::training {

namespace {

constexpr int64_t kShortUnit = 8;
constexpr uint64_t kWindowStream = 0x77696e64;

size_t pick(const std::vector<double>& cumulative, double uniform) {
  const auto found =
      std::upper_bound(cumulative.begin(), cumulative.end(), uniform * cumulative.back());
  return std::min<size_t>(static_cast<size_t>(found - cumulative.begin()), cumulative.size() - 1);
}

}  // namespace

WindowSampler::WindowSampler(std::vector<const motion::Features*> clips,
                             const WindowSamplerOptions& options)
    : clips_(std::move(clips)), batch_frames_(options.batch_frames) {
  std::map<int64_t, std::vector<size_t>> short_clips;
  std::vector<size_t> whole, twice, thrice;
  double short_frames = 0, all_frames = 0;
  for (size_t i = 0; i < clips_.size(); ++i) {
    const int64_t frames = clips_[i]->frames;
    if (frames < kShortUnit) continue;
    all_frames += static_cast<double>(frames);
    if (frames < options.window) {
      short_clips[frames / kShortUnit * kShortUnit].push_back(i);
      short_frames += static_cast<double>(frames);
      continue;
    }
    whole.push_back(i);
    if (frames >= 2 * options.window) twice.push_back(i);
    if (frames >= 3 * options.window) thrice.push_back(i);
  }
  if (all_frames == 0) throw Error("training windows: no clip has at least 8 frames");
  for (const auto& [frames, members] : short_clips) {
    double pool_frames = 0;
    for (const size_t i : members) pool_frames += clips_[i]->frames;
    add_pool(frames, pool_frames, members);
  }
  const double rest = all_frames - short_frames;
  const double long_share = twice.empty() ? 0 : options.long_share;
  const double thrice_share = thrice.empty() ? 0 : long_share / 2;
  add_pool(options.window, rest * (1 - long_share), whole);
  add_pool(2 * options.window, rest * (long_share - thrice_share), twice);
  add_pool(3 * options.window, rest * thrice_share, thrice);
}

void WindowSampler::add_pool(int64_t frames, double share, const std::vector<size_t>& members) {
  if (members.empty() || share <= 0) return;
  Pool pool;
  pool.frames = frames;
  pool.clips = members;
  double sum = 0;
  for (const size_t i : members) pool.cumulative.push_back(sum += clips_[i]->frames);
  pools_.push_back(std::move(pool));
  pool_cumulative_.push_back((pool_cumulative_.empty() ? 0 : pool_cumulative_.back()) + share);
}

at::Tensor WindowSampler::batch(uint64_t seed, int64_t step) const {
  CounterRandom random(mix_seed(seed, kWindowStream), static_cast<uint64_t>(step));
  const Pool& pool = pools_[pick(pool_cumulative_, random.uniform())];
  const int64_t count = std::max<int64_t>(1, batch_frames_ / pool.frames);
  std::vector<at::Tensor> windows;
  for (int64_t i = 0; i < count; ++i) {
    const motion::Features& clip = *clips_[pool.clips[pick(pool.cumulative, random.uniform())]];
    const auto first = random.below(static_cast<size_t>(clip.frames - pool.frames + 1));
    windows.push_back(tokenizer::feature_rows(clip, static_cast<int64_t>(first), pool.frames));
  }
  return torch::stack(windows);
}

}  // namespace remomask::training
