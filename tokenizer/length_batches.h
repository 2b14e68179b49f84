#pragma once

#include <ATen/core/Tensor.h>

#include <vector>

#include "motion/features.h"

namespace remomask::tokenizer {

/// Clips of one length that are processed together.
struct LengthBatch {
  int64_t frames = 0;           ///< of every clip, a multiple of `unit`
  std::vector<size_t> members;  ///< indices of the clips
};

/// Groups clips by their length rounded down to a multiple of `unit`, shortest
/// first, at most `batch` together; clips shorter than `unit` are in no batch.
/// Nothing is ever padded.
std::vector<LengthBatch> batches_by_length(const std::vector<const motion::Features*>& clips,
                                           int64_t unit, size_t batch);

/// Rows [first, first + frames) of one clip -> [frames, D], a copy.
at::Tensor feature_rows(const motion::Features& features, int64_t first, int64_t frames);

/// The clips of a batch from their first row -> [B, frames, D].
at::Tensor stack_batch(const std::vector<const motion::Features*>& clips, const LengthBatch& batch);

}  // namespace remomask::tokenizer
