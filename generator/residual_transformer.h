#pragma once

#include <torch/nn/module.h>
#include <torch/nn/modules/embedding.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "generator/ssta.h"
#include "nn/model_file.h"

namespace remomask::generator {

/// Sizes of the residual transformer.
struct ResidualConfig {
  std::string preset = "base";
  int64_t rows = 6;
  int64_t levels = 6;  ///< of the tokenizer: base level + residual levels
  int64_t codes = 256;
  int64_t width = 256;
  int64_t heads = 4;
  int64_t layers = 4;
  int64_t hidden = 512;
  double dropout = 0.1;
  int64_t text_width = 256;
  int64_t embedding_width = 256;
  std::string attention = "ssta";  ///< or "joined": ordinary attention over [t; z]
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ResidualConfig, preset, rows, levels, codes, width, heads,
                                   layers, hidden, dropout, text_width, embedding_width, attention)

/// Predicts the tokens of residual level l from the levels below it (MoMask
/// 3.3), with STA: text is the only condition. One table [levels, rows, codes,
/// D] serves as input embedding of levels 0 .. levels-2 and as output
/// projection of levels 1 .. levels-1, so that those in between share weights.
class ResidualTransformerImpl : public torch::nn::Module {
 public:
  explicit ResidualTransformerImpl(const ResidualConfig& config);

  std::vector<ConditionCache> prepare(const Condition& condition);
  /// tokens [B, T, rows, q] int64, q >= every level; level [B] int64 in 1 ..
  /// levels-1, on the CPU: sample b reads tokens below level[b]. frame_mask as
  /// in MaskedTransformer. Returns logits [B, T * rows, codes] of that level.
  at::Tensor forward(const at::Tensor& tokens, const at::Tensor& level,
                     const std::vector<ConditionCache>& condition,
                     const at::Tensor& frame_mask = {},
                     std::vector<at::Tensor>* after_block = nullptr);

  const ResidualConfig& config() const { return config_; }

 private:
  ResidualConfig config_;
  at::Tensor tables_;
  torch::nn::Embedding level_table_;
  std::shared_ptr<AttentionStackImpl> stack_;
};
TORCH_MODULE(ResidualTransformer);

/// The config of a stage; what files of earlier versions do not say has its default.
ResidualConfig residual_config(nlohmann::json stage_config);

/// Model <-> stage of a model file (kind "residual").
nn::ModelStage residual_stage(const ResidualTransformer& model);
ResidualTransformer load_residual(const nn::ModelStage& stage);

}  // namespace remomask::generator
