#pragma once

#include <torch/nn/modules/embedding.h>
#include <torch/nn/modules/linear.h>
#include <torch/nn/modules/normalization.h>

#include "generator/ssta.h"
#include "nn/layers.h"

namespace remomask::generator {

/// What SSTA is compared with (ReMoMask, ablation without SSTA; MoMask): the
/// condition stands before the tokens as [t; R; z], and the whole sequence goes
/// through ordinary self-attention. One projection makes key and value of every
/// row, there is no relative bias, and the condition rows change from block to
/// block like the tokens. A hit is one row W [R_m, R_t, s], followed by
/// its states where they are read; a learned vector
/// tells the kinds of rows apart.
class JoinedStackImpl : public AttentionStackImpl {
 public:
  JoinedStackImpl(const SstaConfig& config, int64_t layers);

  /// One entry: the condition rows as `keys`, their visibility as `bias`
  /// [B, 1, C] (0 or -inf); no values.
  std::vector<ConditionCache> prepare(const Condition& condition,
                                      const HitStates& hit_states = {}) override;
  at::Tensor forward(at::Tensor x, const std::vector<ConditionCache>& condition,
                     const at::Tensor& frame_mask,
                     std::vector<at::Tensor>* after_block = nullptr) override;
  /// N(0, 0.02) weights, zero biases.
  void initialise() override;

 private:
  SstaConfig config_;
  ConditionEncoder condition_encoder_;
  torch::nn::Linear hit_{nullptr};
  torch::nn::Embedding kind_;
  std::vector<nn::EncoderBlock> blocks_;
  torch::nn::LayerNorm final_norm_;
};
TORCH_MODULE(JoinedStack);

}  // namespace remomask::generator
