#pragma once

#include <torch/nn/module.h>

#include <vector>

#include "tokenizer/part_map.h"
#include "tokenizer/residual_quantizer.h"
#include "tokenizer/row_layers.h"
#include "tokenizer/tokenizer.h"

namespace remomask::tokenizer {

/// Throws Error when sizes contradict each other.
void check_tokenizer_config(const TokenizerConfig& config);

/// Patches or convolutions down to T/4, residual blocks over time, exchange
/// between rows, projection to the width of a code.
class TokenizerEncoderImpl : public torch::nn::Module {
 public:
  TokenizerEncoderImpl(const TokenizerConfig& config, int64_t row_channels);
  /// [R, B, 4 n, row_channels] -> [R, B, n, code_width].
  at::Tensor forward(const at::Tensor& x);

 private:
  int64_t patch_;
  RowLinear patch_layer_ = nullptr;
  TimeConv first_ = nullptr, last_ = nullptr;
  std::vector<TimeConv> down_;
  std::vector<RowBlockStack> stacks_;
  RowMixer mixer_ = nullptr;
};
TORCH_MODULE(TokenizerEncoder);

/// The encoder backwards.
class TokenizerDecoderImpl : public torch::nn::Module {
 public:
  TokenizerDecoderImpl(const TokenizerConfig& config, int64_t row_channels);
  /// [R, B, n, code_width] -> [R, B, 4 n, row_channels].
  at::Tensor forward(const at::Tensor& z);

 private:
  int64_t patch_;
  TimeConv first_ = nullptr, last_ = nullptr, output_ = nullptr;
  TimeConv smooth_in_ = nullptr, smooth_out_ = nullptr;
  RowLinear patch_layer_ = nullptr;
  std::vector<TimeConv> up_;
  std::vector<RowBlockStack> stacks_;
  RowMixer mixer_ = nullptr;
};
TORCH_MODULE(TokenizerDecoder);

struct TokenizerOutput {
  at::Tensor features;  ///< [B, 4 n, D] normalised reconstruction
  Quantized quantized;
};

/// 2D residual VQ-VAE over normalised features; mean and std of the training
/// data are buffers.
class TokenizerNetworkImpl : public torch::nn::Module {
 public:
  /// Throws Error when the config contradicts itself.
  explicit TokenizerNetworkImpl(const TokenizerConfig& config);

  /// Normalised features [B, 4 n, D] -> latents [groups, N, code_width] as the
  /// quantiser takes them: N = B n with a codebook a row, R B n with one for all.
  at::Tensor encode(const at::Tensor& normalised);
  /// Such latents of `batch` clips -> normalised features [B, 4 n, D].
  at::Tensor decode(const at::Tensor& latents, int64_t batch);
  /// One training pass; see ResidualQuantizerImpl::train_step.
  TokenizerOutput train_step(const at::Tensor& normalised, const CodebookTraining& training,
                             uint64_t seed, int64_t step);

  /// Normalised features [B, 4 n, D] -> int64 [B, n, rows, levels].
  at::Tensor tokens(const at::Tensor& normalised);
  /// int64 [B, n, rows, q] -> normalised features [B, 4 n, D].
  at::Tensor from_tokens(const at::Tensor& tokens);

  void set_statistics(const at::Tensor& mean, const at::Tensor& deviation);
  at::Tensor normalise(const at::Tensor& features) const;
  at::Tensor denormalise(const at::Tensor& normalised) const;

  const TokenizerConfig& config() const { return config_; }
  const Skeleton& skeleton() const { return skeleton_; }
  ResidualQuantizer& quantizer() { return quantizer_; }
  const at::Tensor& mean() const { return mean_; }
  const at::Tensor& deviation() const { return deviation_; }

 private:
  TokenizerConfig config_;
  const Skeleton& skeleton_;
  PartMap part_map_;
  TokenizerEncoder encoder_;
  ResidualQuantizer quantizer_;
  TokenizerDecoder decoder_;
  at::Tensor mean_, deviation_;
};
TORCH_MODULE(TokenizerNetwork);

/// The network of a stage, in eval mode. Throws Error for another kind or
/// tensors that do not fit.
TokenizerNetwork load_tokenizer_network(const nn::ModelStage& stage);

}  // namespace remomask::tokenizer
