#pragma once

#include <torch/nn/module.h>
#include <torch/nn/modules/dropout.h>
#include <torch/nn/modules/linear.h>

#include <vector>

namespace remomask::tokenizer {

/// Layers on token maps in the layout [R, B, T, C]: rows (body parts) first,
/// so that weights of a row's own are one batched matrix product, channels
/// last, so that a convolution over time is a concatenation of shifted slices
/// and one matrix product (on a CPU more than twice as fast as oneDNN's float32
/// convolutions).

/// Linear layer; with `rows` > 0 every row has weights of its own.
class RowLinearImpl : public torch::nn::Module {
 public:
  /// rows 0: one weight for all rows. Initialised as torch::nn::Linear is.
  RowLinearImpl(int64_t rows, int64_t inputs, int64_t outputs);
  /// [R, B, T, inputs] -> [R, B, T, outputs].
  at::Tensor forward(const at::Tensor& x);

 private:
  at::Tensor weight_;  ///< [max(1, rows), inputs, outputs]
  at::Tensor bias_;    ///< [max(1, rows), 1, outputs]
};
TORCH_MODULE(RowLinear);

/// Convolution over time with zero padding at the true ends.
class TimeConvImpl : public torch::nn::Module {
 public:
  /// `taps` slices, `dilation` apart, every `stride` frames, `padding` zero
  /// frames at both ends.
  TimeConvImpl(int64_t rows, int64_t inputs, int64_t outputs, int64_t taps, int64_t stride,
               int64_t padding, int64_t dilation);
  /// [R, B, T, inputs] -> [R, B, T', outputs].
  at::Tensor forward(const at::Tensor& x);

 private:
  int64_t taps_, stride_, padding_, dilation_;
  RowLinear linear_;
};
TORCH_MODULE(TimeConv);

/// x + Dropout(Linear(ReLU(Conv3(ReLU(x))))), the residual block of MoMask.
class RowBlockImpl : public torch::nn::Module {
 public:
  RowBlockImpl(int64_t rows, int64_t width, int64_t dilation, double dropout);
  at::Tensor forward(const at::Tensor& x);

 private:
  TimeConv convolution_;
  RowLinear linear_;
  torch::nn::Dropout dropout_;
};
TORCH_MODULE(RowBlock);

/// Blocks with dilation growth^2, growth, 1, growth^2, ... so that the last one
/// has dilation 1.
class RowBlockStackImpl : public torch::nn::Module {
 public:
  RowBlockStackImpl(int64_t rows, int64_t width, int64_t blocks, int64_t growth, double dropout);
  at::Tensor forward(at::Tensor x);

 private:
  std::vector<RowBlock> blocks_;
};
TORCH_MODULE(RowBlockStack);

/// Exchange between the rows of one token frame: x + MLP(all rows of the frame).
class RowMixerImpl : public torch::nn::Module {
 public:
  RowMixerImpl(int64_t rows, int64_t width, int64_t hidden);
  /// [R, B, T, C] -> the same shape.
  at::Tensor forward(const at::Tensor& x);

 private:
  torch::nn::Linear expand_, contract_;
};
TORCH_MODULE(RowMixer);

}  // namespace remomask::tokenizer
