#include "retriever/projection.h"

#include <torch/nn/functional/normalization.h>

namespace remomask {

namespace nn = torch::nn;

at::Tensor unit_rows(const at::Tensor& x) {
  return nn::functional::normalize(x, nn::functional::NormalizeFuncOptions().dim(-1));
}

ProjectionHead::ProjectionHead(int64_t input, int64_t output, double dropout)
    : enter_(register_module("enter", nn::Linear(input, output))),
      deepen_(register_module("deepen", nn::Linear(output, output))),
      norm_(register_module("norm", nn::LayerNorm(nn::LayerNormOptions({output})))),
      dropout_(register_module("dropout", nn::Dropout(dropout))) {}

at::Tensor ProjectionHead::forward(const at::Tensor& x) {
  const at::Tensor p = enter_(x);
  return unit_rows(norm_(p + dropout_(deepen_(torch::gelu(p)))));
}

}  // namespace remomask
