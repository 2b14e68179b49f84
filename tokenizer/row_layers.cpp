#include "tokenizer/row_layers.h"

#include <torch/nn/functional/padding.h>

#include <cmath>

namespace remomask::tokenizer {

RowLinearImpl::RowLinearImpl(int64_t rows, int64_t inputs, int64_t outputs) {
  const int64_t groups = std::max<int64_t>(1, rows);
  const double bound = 1 / std::sqrt(static_cast<double>(inputs));
  weight_ =
      register_parameter("weight", torch::empty({groups, inputs, outputs}).uniform_(-bound, bound));
  bias_ = register_parameter("bias", torch::empty({groups, 1, outputs}).uniform_(-bound, bound));
}

at::Tensor RowLinearImpl::forward(const at::Tensor& x) {
  auto shape = x.sizes().vec();
  shape.back() = weight_.size(2);
  if (weight_.size(0) == 1) {
    return torch::addmm(bias_[0], x.reshape({-1, x.size(-1)}), weight_[0]).view(shape);
  }
  return torch::baddbmm(bias_, x.reshape({x.size(0), -1, x.size(-1)}), weight_).view(shape);
}

TimeConvImpl::TimeConvImpl(int64_t rows, int64_t inputs, int64_t outputs, int64_t taps,
                           int64_t stride, int64_t padding, int64_t dilation)
    : taps_(taps),
      stride_(stride),
      padding_(padding),
      dilation_(dilation),
      linear_(register_module("linear", RowLinear(rows, taps * inputs, outputs))) {}

at::Tensor TimeConvImpl::forward(const at::Tensor& x) {
  const auto padded = torch::constant_pad_nd(x, {0, 0, padding_, padding_});
  const int64_t frames = (padded.size(2) - dilation_ * (taps_ - 1) - 1) / stride_ + 1;
  std::vector<at::Tensor> slices;
  for (int64_t tap = 0; tap < taps_; ++tap) {
    const int64_t first = tap * dilation_;
    slices.push_back(padded.slice(2, first, first + (frames - 1) * stride_ + 1, stride_));
  }
  return linear_(torch::cat(slices, -1));
}

RowBlockImpl::RowBlockImpl(int64_t rows, int64_t width, int64_t dilation, double dropout)
    : convolution_(
          register_module("convolution", TimeConv(rows, width, width, 3, 1, dilation, dilation))),
      linear_(register_module("linear", RowLinear(rows, width, width))),
      dropout_(register_module("dropout", torch::nn::Dropout(dropout))) {}

at::Tensor RowBlockImpl::forward(const at::Tensor& x) {
  return x + dropout_(linear_(torch::relu(convolution_(torch::relu(x)))));
}

RowBlockStackImpl::RowBlockStackImpl(int64_t rows, int64_t width, int64_t blocks, int64_t growth,
                                     double dropout) {
  for (int64_t i = 0; i < blocks; ++i) {
    const int64_t power = (blocks - 1 - i) % 3;
    int64_t dilation = 1;
    for (int64_t k = 0; k < power; ++k) dilation *= growth;
    blocks_.push_back(
        register_module("block" + std::to_string(i), RowBlock(rows, width, dilation, dropout)));
  }
}

at::Tensor RowBlockStackImpl::forward(at::Tensor x) {
  for (auto& block : blocks_) x = block(x);
  return x;
}

RowMixerImpl::RowMixerImpl(int64_t rows, int64_t width, int64_t hidden)
    : expand_(register_module("expand", torch::nn::Linear(rows * width, hidden))),
      contract_(register_module("contract", torch::nn::Linear(hidden, rows * width))) {}

at::Tensor RowMixerImpl::forward(const at::Tensor& x) {
  const auto frames = x.permute({1, 2, 0, 3});
  const auto mixed = contract_(torch::gelu(expand_(frames.flatten(2))));
  return x + mixed.view(frames.sizes()).permute({2, 0, 1, 3});
}

}  // namespace remomask::tokenizer
