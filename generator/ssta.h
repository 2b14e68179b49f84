#pragma once

#include <torch/nn/module.h>
#include <torch/nn/modules/embedding.h>
#include <torch/nn/modules/linear.h>
#include <torch/nn/modules/normalization.h>

#include "generator/attention_stack.h"
#include "generator/condition.h"

namespace remomask::generator {

/// Sizes of one attention stack.
struct SstaConfig {
  int64_t rows = 6;     ///< rows of the token map
  int64_t width = 256;  ///< D
  int64_t heads = 4;
  int64_t hidden = 1024;
  double dropout = 0.1;
  int64_t text_width = 256;       ///< of Condition::text_states
  int64_t embedding_width = 256;  ///< E
  bool retrieval = true;          ///< false: STA, no retrieval rows at all (residual model, MoMask)
  bool hit_states = false;        ///< retrieved motions are also read frame by frame (HitStates)
  std::string attention = "ssta";  ///< or "joined" (joined_stack.h)
};

/// Throws Error when the width does not fit the heads or the kind of attention
/// is unknown.
void check_attention_sizes(const SstaConfig& config);

/// Token states, the pooled text (or null text), hits, states of hits.
inline constexpr int64_t kConditionKinds = 4;
/// The kinds that a stack can meet: files of models without hit states know three.
int64_t condition_kinds(const SstaConfig& config);

/// Condition rows before the projections of a layer, C = (S + 1) + (k + 1) + N:
/// token states, the pooled text vector (or the null text), hits, the null hit,
/// states of the hits.
struct ConditionRows {
  at::Tensor text;        ///< [B, S+1, D]
  at::Tensor hit_keys;    ///< [B, k+1, 2E+1]: R_m, R_t, similarity; undefined for STA
  at::Tensor hit_values;  ///< [B, k+1, E]: R_m; undefined for STA and joined rows
  at::Tensor hit_states;  ///< [B, N, D]: R_m in time and parts; undefined where there are none
  at::Tensor visible;     ///< [B, C] bool
  at::Tensor kinds;       ///< [C] int64: 0 token state, 1 pooled text, 2 hit, 3 state of a hit
};

/// Brings text and hits to rows. The learned null text stands in for the text
/// where use_text is false; the learned null hit is visible exactly where no
/// hit is (use_retrieval false, or no hit).
class ConditionEncoderImpl : public torch::nn::Module {
 public:
  explicit ConditionEncoderImpl(const SstaConfig& config);
  ConditionRows forward(const Condition& condition, const HitStates& hit_states);

 private:
  SstaConfig config_;
  torch::nn::Linear text_state_, text_query_;
  torch::nn::LayerNorm text_norm_;
  at::Tensor null_text_, null_hit_key_, null_hit_value_;
};
TORCH_MODULE(ConditionEncoder);

/// Which entry of the relative bias table belongs to a pair of tokens:
/// [n * n] int64 for n = frames * rows tokens in time-major order, value
/// ((dt + 48) * rows + row) * rows + row', dt = t' - t clipped to +-48.
at::Tensor relative_position_index(int64_t frames, int64_t rows);

/// Semantic Spatio-Temporal Attention (ReMoMask eq. 8-11, made precise):
/// Q = W_q z; K = [W z; W t; W [R_m, R_t, s]; W h]; V = [W z; W t; W R_m; W h],
/// h the states of the hits;
/// W_o softmax(Q K^T / sqrt(d_h) + b) V with b a learned bias per head over
/// (dt, row, row') for token keys and one scalar per head for each kind of
/// condition row. The value projections of the retrieval rows start at zero:
/// the model starts as a text-only one.
class SstaImpl : public torch::nn::Module {
 public:
  explicit SstaImpl(const SstaConfig& config);

  ConditionCache prepare(const ConditionRows& rows);
  /// z [B, n, D]; index from relative_position_index; token_mask [B, n], true
  /// where a token exists, or undefined when all do. Returns [B, n, D].
  at::Tensor forward(const at::Tensor& z, const ConditionCache& condition,
                     const at::Tensor& position_index, const at::Tensor& token_mask);
  /// Sets the zero-initialised projection; call after the general initialisation.
  void reset_retrieval_values();

 private:
  SstaConfig config_;
  torch::nn::Linear query_key_value_, text_key_value_, output_;
  torch::nn::Linear hit_key_{nullptr}, hit_value_{nullptr};
  torch::nn::Linear hit_state_key_{nullptr}, hit_state_value_{nullptr};
  torch::nn::Embedding position_bias_, kind_bias_;
};
TORCH_MODULE(Ssta);

/// x + SSTA(LN x), then x + FFN(LN x) with GELU (erf); dropout on both branches.
class SstaBlockImpl : public torch::nn::Module {
 public:
  explicit SstaBlockImpl(const SstaConfig& config);
  ConditionCache prepare(const ConditionRows& rows) { return attention_->prepare(rows); }
  at::Tensor forward(const at::Tensor& x, const ConditionCache& condition,
                     const at::Tensor& position_index, const at::Tensor& token_mask);
  Ssta& attention() { return attention_; }

 private:
  double dropout_;
  torch::nn::LayerNorm attention_norm_, feed_forward_norm_;
  Ssta attention_;
  torch::nn::Linear expand_, contract_;
};
TORCH_MODULE(SstaBlock);

/// L blocks of SSTA with their condition encoder.
class SstaStackImpl : public AttentionStackImpl {
 public:
  SstaStackImpl(const SstaConfig& config, int64_t layers);

  /// One entry a layer: keys and values of the condition rows, and as bias
  /// [B, H, C] the scalar of the row's kind.
  std::vector<ConditionCache> prepare(const Condition& condition,
                                      const HitStates& hit_states = {}) override;
  at::Tensor forward(at::Tensor x, const std::vector<ConditionCache>& condition,
                     const at::Tensor& frame_mask,
                     std::vector<at::Tensor>* after_block = nullptr) override;
  /// N(0, 0.02) weights, zero biases, zero retrieval values.
  void initialise() override;

 private:
  SstaConfig config_;
  ConditionEncoder condition_encoder_;
  std::vector<SstaBlock> blocks_;
  torch::nn::LayerNorm final_norm_;
};
TORCH_MODULE(SstaStack);

/// Fixed 2D positions [frames * rows, width]: the first half of the channels
/// holds the sinusoid of the row, the second half that of time.
at::Tensor map_positions(int64_t frames, int64_t rows, int64_t width);

}  // namespace remomask::generator
