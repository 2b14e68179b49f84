#include "training/training_batches.h"

#include <algorithm>
#include <deque>
#include <set>

#include "base/random.h"
#include "text/caption.h"

namespace remomask::training {

namespace {

constexpr uint64_t kEpochStream = 0x65706f6368;
/// Batches that are sorted by length together.
constexpr size_t kBatchesByLength = 8;

}  // namespace

std::vector<db::TrainingClip> captioned_clips(const std::vector<db::TrainingClip>& clips) {
  std::vector<db::TrainingClip> result;
  for (const db::TrainingClip& clip : clips) {
    db::TrainingClip kept = clip;
    std::erase_if(kept.captions,
                  [](const std::string& text) { return text::normalise_caption(text).empty(); });
    if (!kept.captions.empty()) result.push_back(std::move(kept));
  }
  return result;
}

std::vector<std::vector<size_t>> epoch_batches(const std::vector<db::TrainingClip>& clips,
                                               int64_t batch, uint64_t seed, uint64_t epoch) {
  CounterRandom random(seed, mix_seed(kEpochStream, epoch));
  std::vector<size_t> order = random.permutation(clips.size());
  const size_t size = std::min(static_cast<size_t>(batch), clips.size());
  const size_t count = size == 0 ? 0 : clips.size() / size;
  for (size_t first = 0; first < order.size(); first += kBatchesByLength * size) {
    const size_t last = std::min(order.size(), first + kBatchesByLength * size);
    std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(first),
                     order.begin() + static_cast<std::ptrdiff_t>(last), [&](size_t a, size_t b) {
                       return clips[a].features.frames < clips[b].features.frames;
                     });
  }
  std::vector<std::vector<size_t>> batches;
  std::deque<size_t> waiting(order.begin(), order.end());
  while (batches.size() < count) {
    std::vector<size_t> members, deferred;
    std::set<int> groups;
    while (members.size() < size && !waiting.empty()) {
      const size_t index = waiting.front();
      waiting.pop_front();
      const bool fresh = groups.insert(clips[index].group).second;
      (fresh ? members : deferred).push_back(index);
    }
    // Groups are used up: the rest must repeat them.
    while (members.size() < size) {
      members.push_back(deferred.back());
      deferred.pop_back();
    }
    waiting.insert(waiting.begin(), deferred.begin(), deferred.end());
    batches.push_back(std::move(members));
  }
  std::vector<std::vector<size_t>> shuffled;
  for (const size_t i : random.permutation(batches.size())) shuffled.push_back(batches[i]);
  return shuffled;
}

const std::vector<size_t>& EpochBatches::at_step(int64_t step) {
  const auto number = static_cast<uint64_t>(step);
  if (batches_.empty()) batches_ = epoch_batches(clips_, batch_, seed_, epoch_);
  const uint64_t epoch = number / batches_.size();  // every epoch has equally many batches
  if (epoch != epoch_) {
    batches_ = epoch_batches(clips_, batch_, seed_, epoch);
    epoch_ = epoch;
  }
  return batches_[number % batches_.size()];
}

}  // namespace remomask::training
