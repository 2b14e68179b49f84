#include "nn/layers.h"

#include <torch/nn/functional/activation.h>
#include <torch/nn/init.h>
#include <torch/nn/modules/embedding.h>

#include <cmath>
#include <limits>

namespace remomask::nn {

at::Tensor sinusoidal_positions(int64_t count, int64_t width) {
  const auto position = torch::arange(count, torch::kDouble).unsqueeze(1);
  const auto frequency =
      torch::exp(torch::arange(0, width, 2, torch::kDouble) * (-std::log(10000.0) / width));
  const auto angle = position * frequency;
  return torch::stack({torch::sin(angle), torch::cos(angle)}, 2)
      .reshape({count, width})
      .to(torch::kFloat);
}

at::Tensor multi_head_attention(const at::Tensor& q, const at::Tensor& k, const at::Tensor& v,
                                const at::Tensor& bias, int64_t heads) {
  const int64_t batch = q.size(0), width = q.size(2), head_width = width / heads;
  const auto split = [&](const at::Tensor& x) {
    return x.reshape({batch, x.size(1), heads, head_width}).transpose(1, 2);
  };
  auto logits = torch::matmul(split(q) * (1.0 / std::sqrt(static_cast<double>(head_width))),
                              split(k).transpose(2, 3));
  if (bias.defined()) logits = logits + bias;
  return torch::matmul(torch::softmax(logits, -1), split(v))
      .transpose(1, 2)
      .reshape({batch, q.size(1), width});
}

at::Tensor key_mask_bias(const at::Tensor& mask) {
  const auto bias = torch::zeros(mask.sizes(), mask.options().dtype(torch::kFloat));
  return bias.masked_fill(mask.logical_not(), -std::numeric_limits<float>::infinity())
      .unsqueeze(1)
      .unsqueeze(1);
}

FeedForwardImpl::FeedForwardImpl(int64_t width, int64_t hidden, double dropout)
    : expand_(register_module("expand", torch::nn::Linear(width, hidden))),
      contract_(register_module("contract", torch::nn::Linear(hidden, width))),
      dropout_(register_module("dropout", torch::nn::Dropout(dropout))) {}

at::Tensor FeedForwardImpl::forward(const at::Tensor& x) {
  return dropout_(contract_(dropout_(torch::gelu(expand_(x)))));
}

EncoderBlockImpl::EncoderBlockImpl(int64_t width, int64_t heads, int64_t hidden, double dropout)
    : heads_(heads),
      attention_norm_(register_module("attention_norm",
                                      torch::nn::LayerNorm(torch::nn::LayerNormOptions({width})))),
      feed_forward_norm_(register_module(
          "feed_forward_norm", torch::nn::LayerNorm(torch::nn::LayerNormOptions({width})))),
      query_key_value_(register_module("query_key_value", torch::nn::Linear(width, 3 * width))),
      output_(register_module("output", torch::nn::Linear(width, width))),
      feed_forward_(register_module("feed_forward", FeedForward(width, hidden, dropout))),
      dropout_(register_module("dropout", torch::nn::Dropout(dropout))) {}

at::Tensor EncoderBlockImpl::forward(const at::Tensor& x, const at::Tensor& bias) {
  const auto parts = query_key_value_(attention_norm_(x)).chunk(3, -1);
  const auto attended = multi_head_attention(parts[0], parts[1], parts[2], bias, heads_);
  const auto y = x + dropout_(output_(attended));
  return y + feed_forward_(feed_forward_norm_(y));
}

EncoderStackImpl::EncoderStackImpl(int64_t layers, int64_t width, int64_t heads, int64_t hidden,
                                   double dropout)
    : final_norm_(register_module("final_norm",
                                  torch::nn::LayerNorm(torch::nn::LayerNormOptions({width})))) {
  for (int64_t i = 0; i < layers; ++i) {
    blocks_.push_back(
        register_module("block" + std::to_string(i), EncoderBlock(width, heads, hidden, dropout)));
  }
}

at::Tensor EncoderStackImpl::forward(at::Tensor x, const at::Tensor& mask) {
  const auto bias = key_mask_bias(mask);
  for (auto& block : blocks_) x = block(x, bias);
  return final_norm_(x);
}

void initialise_transformer_weights(torch::nn::Module& module) {
  at::NoGradGuard no_grad;
  for (auto& child : module.modules(/*include_self=*/true)) {
    if (auto* linear = child->as<torch::nn::LinearImpl>()) {
      linear->weight.normal_(0, 0.02);
      if (linear->bias.defined()) linear->bias.zero_();
    } else if (auto* embedding = child->as<torch::nn::EmbeddingImpl>()) {
      embedding->weight.normal_(0, 0.02);
    }
  }
}

}  // namespace remomask::nn
