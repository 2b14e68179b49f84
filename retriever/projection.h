#pragma once

#include <torch/nn/module.h>
#include <torch/nn/modules/dropout.h>
#include <torch/nn/modules/linear.h>
#include <torch/nn/modules/normalization.h>

namespace remomask::retriever {

/// Each row divided by its length.
at::Tensor unit_rows(const at::Tensor& x);

/// p = W1 x; y = LayerNorm(p + Dropout(W2 GELU(p))); the result is y of length 1.
class ProjectionHead final : public torch::nn::Module {
 public:
  ProjectionHead(int64_t input, int64_t output, double dropout);
  at::Tensor forward(const at::Tensor& x);

 private:
  torch::nn::Linear enter_, deepen_;
  torch::nn::LayerNorm norm_;
  torch::nn::Dropout dropout_;
};

}  // namespace remomask::retriever
