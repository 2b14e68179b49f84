#pragma once

#include <ATen/core/Tensor.h>

#include <cstdint>
#include <vector>

#include "motion/features.h"

namespace remomask::training {

struct WindowSamplerOptions {
  int64_t window = 64;          ///< frames of most windows
  int64_t batch_frames = 2048;  ///< frames of a batch
  double long_share = 0.25;     ///< share of batches with windows twice or three times as long
};

/// Draws batches of equally long windows from clips; the batch of a step is a
/// function of (seed, step) alone. Clips shorter than the window are used too,
/// in batches of their own (their length rounded down to a multiple of 8).
/// Every frame of the data is about equally likely.
class WindowSampler {
 public:
  /// The clips must outlive the sampler. Throws Error when none has 8 frames.
  WindowSampler(std::vector<const motion::Features*> clips, const WindowSamplerOptions& options);

  /// Unnormalised features [B, T, D].
  at::Tensor batch(uint64_t seed, int64_t step) const;

 private:
  /// Clips that can give windows of one length.
  struct Pool {
    int64_t frames = 0;
    std::vector<size_t> clips;
    std::vector<double> cumulative;  ///< of the clips' lengths
  };
  void add_pool(int64_t frames, double share, const std::vector<size_t>& members);

  std::vector<const motion::Features*> clips_;
  int64_t batch_frames_;
  std::vector<Pool> pools_;
  std::vector<double> pool_cumulative_;
};

}  // namespace remomask::training
