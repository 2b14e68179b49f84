#include "generator/ssta.h"

#include <torch/nn/functional/normalization.h>
#include <torch/nn/init.h>
#include <torch/types.h>

#include <cmath>

#include "base/time.h"
#include "generator/biased_attention.h"
#include "generator/dropout.h"
#include "nn/layers.h"
#include "remomask/error.h"

namespace remomask::generator {

namespace {

// Far below any real logit, yet finite: softmax gives exactly 0 and gradients stay finite.
constexpr double kHiddenKey = -1e4;

torch::nn::LayerNorm layer_norm(int64_t width) {
  return torch::nn::LayerNorm(torch::nn::LayerNormOptions({width}));
}

}  // namespace

int64_t condition_kinds(const SstaConfig& config) {
  return config.hit_states ? kConditionKinds : kConditionKinds - 1;
}

void check_attention_sizes(const SstaConfig& config) {
  if (config.width % (2 * config.heads) != 0 || config.width % 4 != 0) {
    throw Error("transformer: width " + std::to_string(config.width) +
                " must be a multiple of 4 and of twice the number of heads (" +
                std::to_string(config.heads) + ")");
  }
  if (config.attention != "ssta" && config.attention != "joined") {
    throw Error("transformer: there is no attention \"" + config.attention +
                "\"; use ssta or joined");
  }
}

ConditionEncoderImpl::ConditionEncoderImpl(const SstaConfig& config)
    : config_(config),
      text_state_(
          register_module("text_state", torch::nn::Linear(config.text_width, config.width))),
      text_query_(
          register_module("text_query", torch::nn::Linear(config.embedding_width, config.width))),
      text_norm_(register_module("text_norm", layer_norm(config.width))),
      null_text_(register_parameter("null_text", torch::randn({config.width}) * 0.5)) {
  if (!config.retrieval) return;
  null_hit_key_ =
      register_parameter("null_hit_key", torch::randn({2 * config.embedding_width + 1}) * 0.5);
  // Joined rows are key and value at once.
  if (config.attention == "joined") return;
  null_hit_value_ =
      register_parameter("null_hit_value", torch::randn({config.embedding_width}) * 0.5);
}

ConditionRows ConditionEncoderImpl::forward(const Condition& condition,
                                            const HitStates& hit_states) {
  const int64_t batch = condition.text_states.size(0), k = condition.hit_motion.size(1);
  // Unit vectors become vectors of unit components: what the layers expect.
  const double unit_scale = std::sqrt(static_cast<double>(config_.embedding_width));
  const auto use_text = condition.use_text.unsqueeze(1);
  const auto query = text_query_(condition.text_query * unit_scale);
  const auto pooled = torch::where(use_text, query, null_text_.expand_as(query)).unsqueeze(1);

  ConditionRows rows;
  rows.text = text_norm_(torch::cat({text_state_(condition.text_states), pooled}, 1));
  const auto options = condition.text_mask.options();
  std::vector<at::Tensor> visible = {condition.text_mask.logical_and(use_text),
                                     torch::ones({batch, 1}, options)};
  const auto long_options = options.dtype(torch::kLong);
  std::vector<at::Tensor> kinds = {torch::zeros({condition.text_states.size(1)}, long_options),
                                   torch::full({1}, 1, long_options)};
  if (config_.retrieval) {
    const auto keys =
        torch::cat({condition.hit_motion * unit_scale, condition.hit_text * unit_scale,
                    condition.hit_similarity.unsqueeze(2)},
                   2);
    rows.hit_keys = torch::cat({keys, null_hit_key_.expand({batch, 1, null_hit_key_.size(0)})}, 1);
    if (null_hit_value_.defined()) {
      rows.hit_values = torch::cat({condition.hit_motion * unit_scale,
                                    null_hit_value_.expand({batch, 1, null_hit_value_.size(0)})},
                                   1);
    }
    const auto hits = condition.hit_mask.logical_and(condition.use_retrieval.unsqueeze(1));
    visible.push_back(hits);
    visible.push_back(hits.any(1, /*keepdim=*/true).logical_not());
    kinds.push_back(torch::full({k + 1}, 2, long_options));
  }
  if (config_.hit_states && hit_states.states.defined()) {
    rows.hit_states = hit_states.states;
    visible.push_back(hit_states.visible.logical_and(condition.use_retrieval.unsqueeze(1)));
    kinds.push_back(torch::full({hit_states.states.size(1)}, kConditionKinds - 1, long_options));
  }
  rows.visible = torch::cat(visible, 1);
  rows.kinds = torch::cat(kinds, 0);
  return rows;
}

at::Tensor relative_position_index(int64_t frames, int64_t rows) {
  const auto token = torch::arange(frames * rows, torch::kLong);
  const auto time = torch::floor_divide(token, rows), row = token.remainder(rows);
  const auto distance = (time.unsqueeze(0) - time.unsqueeze(1))
                            .clamp(1 - kMaxTokenFrames, kMaxTokenFrames - 1)
                            .add(kMaxTokenFrames - 1);
  return ((distance * rows + row.unsqueeze(1)) * rows + row.unsqueeze(0)).reshape({-1});
}

SstaImpl::SstaImpl(const SstaConfig& config)
    : config_(config),
      query_key_value_(
          register_module("query_key_value", torch::nn::Linear(config.width, 3 * config.width))),
      text_key_value_(
          register_module("text_key_value", torch::nn::Linear(config.width, 2 * config.width))),
      output_(register_module("output", torch::nn::Linear(config.width, config.width))),
      position_bias_(register_module(
          "position_bias",
          torch::nn::Embedding((2 * kMaxTokenFrames - 1) * config.rows * config.rows,
                               config.heads))),
      kind_bias_(register_module("kind_bias",
                                 torch::nn::Embedding(condition_kinds(config), config.heads))) {
  if (config.hit_states) {
    hit_state_key_ =
        register_module("hit_state_key", torch::nn::Linear(config.width, config.width));
    hit_state_value_ =
        register_module("hit_state_value", torch::nn::Linear(config.width, config.width));
  }
  if (!config.retrieval) return;
  hit_key_ =
      register_module("hit_key", torch::nn::Linear(2 * config.embedding_width + 1, config.width));
  hit_value_ =
      register_module("hit_value", torch::nn::Linear(config.embedding_width, config.width));
}

void SstaImpl::reset_retrieval_values() {
  at::NoGradGuard no_grad;
  for (torch::nn::Linear* values : {&hit_value_, &hit_state_value_}) {
    if (values->is_empty()) continue;
    (*values)->weight.zero_();
    (*values)->bias.zero_();
  }
}

ConditionCache SstaImpl::prepare(const ConditionRows& rows) {
  const auto text = text_key_value_(rows.text).chunk(2, 2);
  ConditionCache cache{text[0], text[1], {}};
  if (config_.retrieval) {
    cache.keys = torch::cat({cache.keys, hit_key_(rows.hit_keys)}, 1);
    cache.values = torch::cat({cache.values, hit_value_(rows.hit_values)}, 1);
  }
  if (rows.hit_states.defined()) {
    cache.keys = torch::cat({cache.keys, hit_state_key_(rows.hit_states)}, 1);
    cache.values = torch::cat({cache.values, hit_state_value_(rows.hit_states)}, 1);
  }
  const auto scalars = kind_bias_(rows.kinds).t().unsqueeze(0);  // [1, H, C]
  cache.bias = torch::where(rows.visible.unsqueeze(1), scalars,
                            torch::full({1}, kHiddenKey, scalars.options()));
  return cache;
}

at::Tensor SstaImpl::forward(const at::Tensor& z, const ConditionCache& condition,
                             const at::Tensor& position_index, const at::Tensor& token_mask) {
  const int64_t batch = z.size(0), count = z.size(1), heads = config_.heads;
  const auto parts = query_key_value_(z).chunk(3, 2);
  const auto keys = torch::cat({parts[1], condition.keys}, 1);
  const auto values = torch::cat({parts[2], condition.values}, 1);
  const auto token_bias = token_mask.defined()
                              ? torch::zeros(token_mask.sizes(), z.options())
                                    .masked_fill(token_mask.logical_not(), kHiddenKey)
                                    .unsqueeze(1)
                                    .expand({batch, heads, count})
                              : torch::zeros({1}, z.options()).expand({batch, heads, count});
  const auto key_bias = torch::cat({token_bias, condition.bias}, 2);
  const auto position_bias =
      position_bias_(position_index).reshape({count, count, heads}).permute({2, 0, 1});
  return output_(biased_attention(parts[0], keys, values, position_bias, key_bias));
}

SstaBlockImpl::SstaBlockImpl(const SstaConfig& config)
    : dropout_(config.dropout),
      attention_norm_(register_module("attention_norm", layer_norm(config.width))),
      feed_forward_norm_(register_module("feed_forward_norm", layer_norm(config.width))),
      attention_(register_module("attention", Ssta(config))),
      expand_(register_module("expand", torch::nn::Linear(config.width, config.hidden))),
      contract_(register_module("contract", torch::nn::Linear(config.hidden, config.width))) {}

at::Tensor SstaBlockImpl::forward(const at::Tensor& x, const ConditionCache& condition,
                                  const at::Tensor& position_index, const at::Tensor& token_mask) {
  const auto attended = attention_(attention_norm_(x), condition, position_index, token_mask);
  const auto y = x + counter_dropout(attended, dropout_, is_training());
  const auto fed = contract_(torch::gelu(expand_(feed_forward_norm_(y))));
  return y + counter_dropout(fed, dropout_, is_training());
}

SstaStackImpl::SstaStackImpl(const SstaConfig& config, int64_t layers)
    : config_(config),
      condition_encoder_(register_module("condition", ConditionEncoder(config))),
      final_norm_(register_module("final_norm", layer_norm(config.width))) {
  check_attention_sizes(config);
  for (int64_t i = 0; i < layers; ++i) {
    blocks_.push_back(register_module("block" + std::to_string(i), SstaBlock(config)));
  }
}

void SstaStackImpl::initialise() {
  nn::initialise_transformer_weights(*this);
  for (auto& block : blocks_) block->attention()->reset_retrieval_values();
}

std::vector<ConditionCache> SstaStackImpl::prepare(const Condition& condition,
                                                   const HitStates& hit_states) {
  const ConditionRows rows = condition_encoder_(condition, hit_states);
  std::vector<ConditionCache> caches;
  for (auto& block : blocks_) caches.push_back(block->prepare(rows));
  return caches;
}

at::Tensor SstaStackImpl::forward(at::Tensor x, const std::vector<ConditionCache>& condition,
                                  const at::Tensor& frame_mask,
                                  std::vector<at::Tensor>* after_block) {
  const int64_t frames = x.size(1) / config_.rows;
  const auto index = relative_position_index(frames, config_.rows).to(x.device());
  const auto token_mask =
      frame_mask.defined() ? frame_mask.repeat_interleave(config_.rows, /*dim=*/1) : at::Tensor();
  x = counter_dropout(x + map_positions(frames, config_.rows, config_.width).to(x.options()),
                      config_.dropout, is_training());
  for (size_t i = 0; i < blocks_.size(); ++i) {
    x = blocks_[i]->forward(x, condition[i], index, token_mask);
    if (after_block != nullptr) after_block->push_back(x);
  }
  return final_norm_(x);
}

at::Tensor map_positions(int64_t frames, int64_t rows, int64_t width) {
  const auto row = nn::sinusoidal_positions(rows, width / 2).unsqueeze(0);
  const auto time = nn::sinusoidal_positions(frames, width / 2).unsqueeze(1);
  return torch::cat({row.expand({frames, rows, width / 2}), time.expand({frames, rows, width / 2})},
                    2)
      .reshape({frames * rows, width});
}

}  // namespace remomask::generator
