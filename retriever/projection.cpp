#include "retriever/projection.h"

#include <torch/nn/functional/normalization.h>

namespace remomask::retriever {

at::Tensor unit_rows(const at::Tensor& x) {
  return torch::nn::functional::normalize(x, torch::nn::functional::NormalizeFuncOptions().dim(-1));
}

ProjectionHead::ProjectionHead(int64_t input, int64_t output, double dropout)
    : enter_(register_module("enter", torch::nn::Linear(input, output))),
      deepen_(register_module("deepen", torch::nn::Linear(output, output))),
      norm_(register_module("norm", torch::nn::LayerNorm(torch::nn::LayerNormOptions({output})))),
      dropout_(register_module("dropout", torch::nn::Dropout(dropout))) {}

at::Tensor ProjectionHead::forward(const at::Tensor& x) {
  const at::Tensor p = enter_(x);
  return unit_rows(norm_(p + dropout_(deepen_(torch::gelu(p)))));
}

}  // namespace remomask::retriever
