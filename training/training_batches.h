#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "db/training_set.h"

namespace remomask::training {

/// The clips that have captions, without captions that normalise to nothing.
std::vector<db::TrainingClip> captioned_clips(const std::vector<db::TrainingClip>& clips);

/// Clips of one epoch in batches: no two clips of a group in a batch as long as
/// the groups last; clips of similar length together, so that a batch has no
/// easy negatives by length. A function of (seed, epoch). What does not fill a
/// batch is left out; fewer clips than a batch are one batch.
std::vector<std::vector<size_t>> epoch_batches(const std::vector<db::TrainingClip>& clips,
                                               int64_t batch, uint64_t seed, uint64_t epoch);

/// Which clips come in which step, epoch after epoch; keeps the batches of the
/// present epoch. `clips` must outlive it.
class EpochBatches {
 public:
  EpochBatches(const std::vector<db::TrainingClip>& clips, int64_t batch, uint64_t seed)
      : clips_(clips), batch_(batch), seed_(seed) {}

  /// Indices into the clips: a function of (clips, batch, seed, step).
  const std::vector<size_t>& at_step(int64_t step);

 private:
  const std::vector<db::TrainingClip>& clips_;
  int64_t batch_;
  uint64_t seed_, epoch_ = 0;
  std::vector<std::vector<size_t>> batches_;
};

}  // namespace remomask::training
