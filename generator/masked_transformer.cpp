#include "generator/masked_transformer.h"

#include <torch/types.h>

#include <algorithm>
#include <cmath>

#include "nn/layers.h"
#include "remomask/error.h"

namespace remomask::generator {

namespace {

SstaConfig masked_stack_config(const MaskedConfig& config) {
  return {config.rows,
          config.width,
          config.heads,
          config.hidden,
          config.dropout,
          config.text_width,
          config.embedding_width,
          config.max_hits > 0,
          config.sequence_hits > 0,
          config.attention};
}

MaskedConfig with_possible_hits(MaskedConfig config) {
  config.sequence_hits = std::min(config.sequence_hits, config.max_hits);
  return config;
}

}  // namespace

MaskedTransformerImpl::MaskedTransformerImpl(const MaskedConfig& chosen)
    : config_(with_possible_hits(chosen)),
      token_table_(register_module(
          "token_table", torch::nn::Embedding(config_.rows * (config_.codes + 1), config_.width))),
      stack_(register_module("stack",
                             make_attention_stack(masked_stack_config(config_), config_.layers))),
      head_weight_(register_parameter(
          "head_weight", torch::randn({config_.rows, config_.width, config_.codes}) * 0.02)),
      head_bias_(register_parameter("head_bias", torch::zeros({config_.rows, 1, config_.codes}))) {
  if (config_.sequence_hits > 0) {
    hit_pair_ = register_module("hit_pair", torch::nn::Linear(2 * config_.width, config_.width));
    hit_similarity_ = register_module("hit_similarity", torch::nn::Linear(1, config_.width));
    hit_norm_ = register_module("hit_norm",
                                torch::nn::LayerNorm(torch::nn::LayerNormOptions({config_.width})));
    nn::initialise_transformer_weights(*hit_pair_);
    nn::initialise_transformer_weights(*hit_similarity_);
  }
  torch::NoGradGuard no_grad;
  token_table_->weight.normal_(0, 0.02);
  stack_->initialise();
}

at::Tensor MaskedTransformerImpl::embed(const at::Tensor& tokens) {
  const auto row_offset = torch::arange(config_.rows, tokens.options()) * (config_.codes + 1);
  // Embeddings of N(0, 0.02) are brought to the size of the positions (Vaswani et al. 2017, 3.4).
  return token_table_(tokens + row_offset) * std::sqrt(static_cast<double>(config_.width));
}

HitStates MaskedTransformerImpl::hit_states(const Condition& condition) {
  const int64_t hits = std::min(condition.hit_tokens.size(1), config_.sequence_hits);
  const int64_t frames = (condition.hit_tokens.size(2) + 1) / 2 * 2;
  if (hits == 0 || frames == 0) return {};
  const int64_t batch = condition.hit_tokens.size(0), rows = config_.rows, width = config_.width;
  // Two token frames are one state: half the keys, and no code is lost.
  const auto tokens = torch::constant_pad_nd(condition.hit_tokens.slice(1, 0, hits),
                                             {0, 0, 0, frames - condition.hit_tokens.size(2)}, -1);
  const auto there = tokens.ge(0);
  const auto paired =
      [&](const at::Tensor& x) {  // [B, s, T, rows, ...] -> [B, s, T/2, rows, 2, ...]
        return x.unflatten(2, {frames / 2, 2}).transpose(3, 4);
      };
  const auto codes = embed(tokens.clamp_min(0)) * there.unsqueeze(4);
  const auto positions = map_positions(frames, rows, width)
                             .reshape({frames / 2, 2, rows, width})
                             .select(1, 0)
                             .to(codes.options());
  const auto similarity =
      condition.hit_similarity.slice(1, 0, hits).reshape({batch, hits, 1, 1, 1});
  const auto states =
      hit_norm_(hit_pair_(paired(codes).flatten(4, 5)) + positions + hit_similarity_(similarity));
  const auto visible = paired(there).any(4).logical_and(
      condition.hit_mask.slice(1, 0, hits).reshape({batch, hits, 1, 1}));
  return {states.flatten(1, 3), visible.flatten(1, 3)};
}

std::vector<ConditionCache> MaskedTransformerImpl::prepare(const Condition& condition) {
  return stack_->prepare(condition, hit_states(condition));
}

at::Tensor MaskedTransformerImpl::forward(const at::Tensor& tokens,
                                          const std::vector<ConditionCache>& condition,
                                          const at::Tensor& frame_mask,
                                          std::vector<at::Tensor>* after_block) {
  const int64_t batch = tokens.size(0), frames = tokens.size(1), rows = config_.rows;
  auto x = embed(tokens).flatten(1, 2);
  x = stack_->forward(x, condition, frame_mask, after_block);
  const auto by_row = x.reshape({batch * frames, rows, config_.width}).transpose(0, 1);
  return torch::baddbmm(head_bias_, by_row, head_weight_)
      .transpose(0, 1)
      .reshape({batch, frames * rows, config_.codes});
}

MaskedConfig masked_config(nlohmann::json stage_config) {
  stage_config.emplace("sequence_hits", 0);
  stage_config.emplace("attention", "ssta");
  stage_config.emplace("drops_conditions", true);
  return stage_config.get<MaskedConfig>();
}

nn::ModelStage masked_stage(const MaskedTransformer& model) {
  return {"masked", nlohmann::json(model->config()), nn::module_tensors(*model)};
}

MaskedTransformer load_masked(const nn::ModelStage& stage) {
  if (stage.kind != "masked") {
    throw Error("this stage is a " + stage.kind + ", not a masked transformer");
  }
  MaskedTransformer model(masked_config(stage.config));
  nn::load_module_tensors(*model, stage.tensors, "masked transformer");
  model->eval();
  return model;
}

}  // namespace remomask::generator
