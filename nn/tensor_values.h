#pragma once

#include <ATen/core/Tensor.h>

#include <vector>

namespace remomask::nn {

/// The elements of a tensor in row-major order, as float.
inline std::vector<float> float_vector(const at::Tensor& tensor) {
  const at::Tensor flat = tensor.to(at::kCPU, at::kFloat).contiguous();
  return {flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel()};
}

}  // namespace remomask::nn
