#pragma once

#include <torch/nn/module.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "base/random.h"
#include "motion/features.h"
#include "retriever/config.h"
#include "retriever/projection.h"

namespace remomask::retriever {

/// Crops of clips as patches, one sequence after the other; each sequence
/// begins with a start token.
struct PatchBatch {
  at::Tensor patches;    ///< [encoders, M, patch x widest part + 1]; empty columns are zero, the
                         ///< last column is 1 for start tokens
  at::Tensor positions;  ///< [M] int64; 0 for start tokens, else 1 + place in the crop
  std::vector<int64_t> offsets;  ///< [B + 1] first token of each clip
};

/// A stretch of a clip, with a patch mask that may leave patches out.
struct MotionCrop {
  const motion::Features* features;
  int first = 0, frames = 0;
  std::vector<int64_t> kept;  ///< patches to keep, ascending; empty: all
};

MotionCrop whole_clip(const motion::Features& features);
/// Keeps max(share * frames, 4) or more frames at a random place, then each
/// patch with probability `patch_keep` (at least one).
MotionCrop random_crop(const motion::Features& features, double least_share, double patch_keep,
                       int64_t patch, CounterRandom& random);

struct MotionVectors {
  at::Tensor global;  ///< [B, E], L2-normalised
  at::Tensor parts;   ///< [B, 6, P], each L2-normalised
};

/// The body of the six part encoders: weights of their own for each part, in
/// one computation (grouped matrix products).
class PartBlockImpl;

/// Six transformers, one a body part: patches of `patch` frames, a learned
/// [CLS], sinusoidal positions, pre-norm blocks; the six [CLS] states together
/// through a projection head are the clip's vector (ReMoMask 3.2). With
/// RetrieverConfig::encoders = 1 a single one reads the whole body, and the part
/// vectors are six heads of its state.
/// LayerNorms have no gain and offset of their own: a linear layer follows each.
class MotionEncoder final : public torch::nn::Module {
 public:
  explicit MotionEncoder(const RetrieverConfig& config);

  /// Sets the statistics that features are normalised by (buffers).
  void set_statistics(const std::vector<const motion::Features*>& train);
  /// Normalises and cuts into patches; no gradient. The last partial patch
  /// repeats the last frame. Throws Error for clips under 4 rows, of another
  /// width, or not finite.
  PatchBatch patches(const std::vector<MotionCrop>& crops) const;
  MotionVectors forward(const PatchBatch& batch);
  /// States of the tokens after each block, for tests: [encoders, M, D] each.
  std::vector<at::Tensor> block_states(const PatchBatch& batch);

 private:
  at::Tensor embed(const PatchBatch& batch) const;
  void normalise_row(const float* row, std::vector<float>& normal) const;

  RetrieverConfig config_;
  std::vector<std::vector<int>> columns_;  ///< of each encoder
  int64_t widest_ = 0;
  at::Tensor mean_, inverse_deviation_;   ///< [C]
  at::Tensor embed_weight_, embed_bias_;  ///< [encoders, patch x widest + 1, D], [encoders, 1, D]
  at::Tensor positions_;                  ///< table, not stored
  std::vector<std::shared_ptr<PartBlockImpl>> blocks_;
  std::shared_ptr<ProjectionHead> head_;
  at::Tensor part_weight_, part_bias_;  ///< [6, D, P], [6, 1, P]
};

}  // namespace remomask::retriever
