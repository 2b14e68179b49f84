#pragma once

#include <torch/nn/module.h>

#include <memory>
#include <vector>

#include "generator/condition.h"

namespace remomask::generator {

/// What a stack makes of a condition before it sees any token, so that a
/// generation computes it once. Each kind of stack says what it keeps here.
struct ConditionCache {
  at::Tensor keys;    ///< [B, C, D]
  at::Tensor values;  ///< [B, C, D]
  at::Tensor bias;    ///< [B, H or 1, C], at most -1e4 where a row is hidden
};

/// Retrieved motions as sequences: N states of all hits of a sample.
struct HitStates {
  at::Tensor states;   ///< [B, N, D]; undefined: none
  at::Tensor visible;  ///< [B, N] bool; does not say whether retrieval is used
};

/// Attention blocks and a final LayerNorm over the flattened token map, under a
/// condition.
class AttentionStackImpl : public torch::nn::Module {
 public:
  /// Everything that depends on the condition only; the states of the hits are
  /// read where SstaConfig::hit_states says so.
  virtual std::vector<ConditionCache> prepare(const Condition& condition,
                                              const HitStates& hit_states = {}) = 0;
  /// x [B, n, D], time-major (token t * rows + row), without positions: the 2D
  /// sinusoid is added here. frame_mask [B, n / rows] or undefined.
  /// `after_block`, when given, receives the residual stream of the tokens after
  /// each block.
  virtual at::Tensor forward(at::Tensor x, const std::vector<ConditionCache>& condition,
                             const at::Tensor& frame_mask,
                             std::vector<at::Tensor>* after_block = nullptr) = 0;
  /// The weights that training starts from.
  virtual void initialise() = 0;
};

struct SstaConfig;

/// The stack that `config.attention` names: "ssta" or "joined". Throws Error for
/// another name and for sizes that do not fit.
std::shared_ptr<AttentionStackImpl> make_attention_stack(const SstaConfig& config, int64_t layers);

}  // namespace remomask::generator
