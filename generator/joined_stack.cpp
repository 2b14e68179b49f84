#include "generator/joined_stack.h"

#include <torch/types.h>

#include "generator/dropout.h"

namespace remomask::generator {

JoinedStackImpl::JoinedStackImpl(const SstaConfig& config, int64_t layers)
    : config_(config),
      condition_encoder_(register_module("condition", ConditionEncoder(config))),
      kind_(register_module("kind", torch::nn::Embedding(condition_kinds(config), config.width))),
      final_norm_(register_module(
          "final_norm", torch::nn::LayerNorm(torch::nn::LayerNormOptions({config.width})))) {
  check_attention_sizes(config);
  if (config.retrieval) {
    hit_ = register_module("hit", torch::nn::Linear(2 * config.embedding_width + 1, config.width));
  }
  for (int64_t i = 0; i < layers; ++i) {
    blocks_.push_back(register_module(
        "block" + std::to_string(i),
        nn::EncoderBlock(config.width, config.heads, config.hidden, config.dropout)));
  }
}

void JoinedStackImpl::initialise() { nn::initialise_transformer_weights(*this); }

std::vector<ConditionCache> JoinedStackImpl::prepare(const Condition& condition,
                                                     const HitStates& hit_states) {
  const ConditionRows rows = condition_encoder_(condition, hit_states);
  at::Tensor joined = rows.text;
  if (config_.retrieval) joined = torch::cat({joined, hit_(rows.hit_keys)}, 1);
  if (rows.hit_states.defined()) joined = torch::cat({joined, rows.hit_states}, 1);
  return {{joined + kind_(rows.kinds), {}, nn::key_mask_bias(rows.visible).squeeze(1)}};
}

at::Tensor JoinedStackImpl::forward(at::Tensor x, const std::vector<ConditionCache>& condition,
                                    const at::Tensor& frame_mask,
                                    std::vector<at::Tensor>* after_block) {
  const at::Tensor& rows = condition.front().keys;
  const int64_t batch = x.size(0), count = x.size(1), before = rows.size(1);
  const int64_t frames = count / config_.rows;
  const at::Tensor token_bias =
      frame_mask.defined()
          ? nn::key_mask_bias(frame_mask.repeat_interleave(config_.rows, 1)).squeeze(1)
          : torch::zeros({batch, 1, count}, x.options());
  const at::Tensor bias = torch::cat({condition.front().bias, token_bias}, 2).unsqueeze(1);
  x = x + map_positions(frames, config_.rows, config_.width).to(x.options());
  x = counter_dropout(torch::cat({rows, x}, 1), config_.dropout, is_training());
  for (auto& block : blocks_) {
    x = block(x, bias);
    if (after_block != nullptr) after_block->push_back(x.slice(1, before));
  }
  return final_norm_(x.slice(1, before));
}

std::shared_ptr<AttentionStackImpl> make_attention_stack(const SstaConfig& config, int64_t layers) {
  if (config.attention == "joined") return std::make_shared<JoinedStackImpl>(config, layers);
  return std::make_shared<SstaStackImpl>(config, layers);
}

}  // namespace remomask::generator
