#pragma once

#include <torch/nn/module.h>
#include <torch/nn/modules/dropout.h>
#include <torch/nn/modules/linear.h>
#include <torch/nn/modules/normalization.h>

#include <vector>

namespace remomask::nn {

/// Sinusoidal positions (Vaswani et al. 2017), interleaved sin, cos:
/// [count, width]; width even.
at::Tensor sinusoidal_positions(int64_t count, int64_t width);

/// Multi-head softmax attention: softmax(Q K^T / sqrt(d_h) + bias) V per head.
/// q [B, N, D]; k, v [B, M, D]; bias broadcastable to [B, H, N, M] (additive;
/// -inf hides a key) or undefined. Returns [B, N, D].
at::Tensor multi_head_attention(const at::Tensor& q, const at::Tensor& k, const at::Tensor& v,
                                const at::Tensor& bias, int64_t heads);

/// Additive bias [B, 1, 1, M] from a mask [B, M] that is true where a key
/// exists. A row must keep at least one key.
at::Tensor key_mask_bias(const at::Tensor& mask);

/// Two linear layers with GELU (erf) between, dropout after both.
class FeedForwardImpl : public torch::nn::Module {
 public:
  FeedForwardImpl(int64_t width, int64_t hidden, double dropout);
  at::Tensor forward(const at::Tensor& x);

 private:
  torch::nn::Linear expand_, contract_;
  torch::nn::Dropout dropout_;
};
TORCH_MODULE(FeedForward);

/// Pre-norm self-attention block: x + Attention(LN x), x + FFN(LN x).
class EncoderBlockImpl : public torch::nn::Module {
 public:
  EncoderBlockImpl(int64_t width, int64_t heads, int64_t hidden, double dropout);
  /// x [B, N, D]; bias as in multi_head_attention.
  at::Tensor forward(const at::Tensor& x, const at::Tensor& bias);

 private:
  int64_t heads_;
  torch::nn::LayerNorm attention_norm_, feed_forward_norm_;
  torch::nn::Linear query_key_value_, output_;
  FeedForward feed_forward_;
  torch::nn::Dropout dropout_;
};
TORCH_MODULE(EncoderBlock);

/// Stack of encoder blocks with a final LayerNorm.
class EncoderStackImpl : public torch::nn::Module {
 public:
  EncoderStackImpl(int64_t layers, int64_t width, int64_t heads, int64_t hidden, double dropout);
  /// x [B, N, D], mask [B, N] true where a token exists.
  at::Tensor forward(at::Tensor x, const at::Tensor& mask);

 private:
  std::vector<EncoderBlock> blocks_;
  torch::nn::LayerNorm final_norm_;
};
TORCH_MODULE(EncoderStack);

/// N(0, 0.02) for every Linear and Embedding weight, zero biases.
void initialise_transformer_weights(torch::nn::Module& module);

}  // namespace remomask::nn
