#include "generator/masked_transformer.h"

#include <torch/types.h>

#include <cmath>

#include "base/error.h"

namespace remomask {

namespace {

SstaConfig masked_stack_config(const MaskedConfig& config) {
  return {config.rows,    config.width,      config.heads,           config.hidden,
          config.dropout, config.text_width, config.embedding_width, config.max_hits > 0};
}

}  // namespace

MaskedTransformerImpl::MaskedTransformerImpl(const MaskedConfig& config)
    : config_(config),
      token_table_(register_module(
          "token_table", torch::nn::Embedding(config.rows * (config.codes + 1), config.width))),
      stack_(register_module("stack", SstaStack(masked_stack_config(config), config.layers))),
      head_weight_(register_parameter(
          "head_weight", torch::randn({config.rows, config.width, config.codes}) * 0.02)),
      head_bias_(register_parameter("head_bias", torch::zeros({config.rows, 1, config.codes}))) {
  torch::NoGradGuard no_grad;
  token_table_->weight.normal_(0, 0.02);
  stack_->initialise();
}

std::vector<ConditionCache> MaskedTransformerImpl::prepare(const Condition& condition) {
  return stack_->prepare(condition);
}

at::Tensor MaskedTransformerImpl::forward(const at::Tensor& tokens,
                                          const std::vector<ConditionCache>& condition,
                                          const at::Tensor& frame_mask,
                                          std::vector<at::Tensor>* after_block) {
  const int64_t batch = tokens.size(0), frames = tokens.size(1), rows = config_.rows;
  const auto row_offset = torch::arange(rows, tokens.options()) * (config_.codes + 1);
  // Embeddings of N(0, 0.02) are brought to the size of the positions (Vaswani et al. 2017, 3.4).
  auto x = token_table_((tokens + row_offset).reshape({batch, frames * rows})) *
           std::sqrt(static_cast<double>(config_.width));
  x = stack_(x, condition, frame_mask, after_block);
  const auto by_row = x.reshape({batch * frames, rows, config_.width}).transpose(0, 1);
  return torch::baddbmm(head_bias_, by_row, head_weight_)
      .transpose(0, 1)
      .reshape({batch, frames * rows, config_.codes});
}

ModelStage masked_stage(const MaskedTransformer& model) {
  return {"masked", nlohmann::json(model->config()), module_tensors(*model)};
}

MaskedTransformer load_masked(const ModelStage& stage) {
  if (stage.kind != "masked") {
    throw Error("this stage is a " + stage.kind + ", not a masked transformer");
  }
  MaskedTransformer model(stage.config.get<MaskedConfig>());
  load_module_tensors(*model, stage.tensors, "masked transformer");
  model->eval();
  return model;
}

}  // namespace remomask
