#include "generator/biased_attention.h"

#include <torch/types.h>

#include <cmath>

namespace remomask {

at::Tensor biased_attention(const at::Tensor& q, const at::Tensor& k, const at::Tensor& v,
                            const at::Tensor& position, const at::Tensor& key) {
  const int64_t batch = q.size(0), count = q.size(1), width = q.size(2), keys = k.size(1);
  const int64_t heads = position.size(0), head_width = width / heads;
  const auto split = [&](const at::Tensor& x) {
    return x.reshape({batch, x.size(1), heads, head_width}).transpose(1, 2);
  };
  const auto logits = torch::matmul(split(q) * (1.0 / std::sqrt(static_cast<double>(head_width))),
                                    split(k).transpose(2, 3));
  const auto bias = torch::constant_pad_nd(position, {0, keys - count});
  const auto weights = torch::softmax(logits + bias + key.unsqueeze(2), -1);
  return torch::matmul(weights, split(v)).transpose(1, 2).reshape({batch, count, width});
}

}  // namespace remomask
