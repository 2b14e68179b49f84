#pragma once

#include <torch/nn/module.h>
#include <torch/nn/modules/embedding.h>
#include <torch/nn/modules/linear.h>
#include <torch/nn/modules/normalization.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "generator/ssta.h"
#include "nn/model_file.h"

namespace remomask::generator {

/// Sizes of the masked transformer.
struct MaskedConfig {
  std::string preset = "base";
  int64_t rows = 6;     ///< rows of the token map
  int64_t codes = 256;  ///< entries of the base codebook of every row
  int64_t width = 256;
  int64_t heads = 4;
  int64_t layers = 4;
  int64_t hidden = 512;
  double dropout = 0.1;
  int64_t text_width = 256;        ///< of the text tower's token states
  int64_t embedding_width = 256;   ///< of the shared text-motion space
  int64_t max_hits = 4;            ///< most retrieved motions; 0: no retrieval path at all
  int64_t sequence_hits = 0;       ///< the best so many are also read as token maps
  std::string attention = "ssta";  ///< or "joined": ordinary attention over [t; R; z]
  /// Conditions were dropped now and then in training (RAG-CFG); without that
  /// there is nothing that guidance could compare with.
  bool drops_conditions = true;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MaskedConfig, preset, rows, codes, width, heads, layers, hidden,
                                   dropout, text_width, embedding_width, max_hits, sequence_hits,
                                   attention, drops_conditions)

/// Predicts the base tokens of a map [T, rows] under a condition (ReMoMask 3.3).
/// Codebooks are per row, hence so are token table and output head.
class MaskedTransformerImpl : public torch::nn::Module {
 public:
  explicit MaskedTransformerImpl(const MaskedConfig& config);

  /// Condition::hit_tokens are of this model's tokenizer; hits beyond
  /// sequence_hits are read as vectors only.
  std::vector<ConditionCache> prepare(const Condition& condition);
  /// tokens [B, T, rows] int64, codes or mask_token(); frame_mask [B, T] bool,
  /// true where a frame exists, or undefined when all do (values of tokens that
  /// do not exist are ignored). Returns logits [B, T * rows, codes], time-major.
  at::Tensor forward(const at::Tensor& tokens, const std::vector<ConditionCache>& condition,
                     const at::Tensor& frame_mask = {},
                     std::vector<at::Tensor>* after_block = nullptr);

  int64_t mask_token() const { return config_.codes; }
  const MaskedConfig& config() const { return config_; }

 private:
  at::Tensor embed(const at::Tensor& tokens);
  HitStates hit_states(const Condition& condition);

  MaskedConfig config_;
  torch::nn::Embedding token_table_;
  torch::nn::Linear hit_pair_{nullptr}, hit_similarity_{nullptr};
  torch::nn::LayerNorm hit_norm_{nullptr};
  std::shared_ptr<AttentionStackImpl> stack_;
  at::Tensor head_weight_, head_bias_;
};
TORCH_MODULE(MaskedTransformer);

/// The config of a stage; what files of earlier versions do not say has its default.
MaskedConfig masked_config(nlohmann::json stage_config);

/// Model <-> stage of a model file (kind "masked").
nn::ModelStage masked_stage(const MaskedTransformer& model);
/// Throws Error for another kind or tensors that do not fit. In eval mode.
MaskedTransformer load_masked(const nn::ModelStage& stage);

}  // namespace remomask::generator
