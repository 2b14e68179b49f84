#include "training/bmm_loss.h"

#include <torch/nn/functional/loss.h>

#include <cmath>
#include <limits>

namespace remomask::training {

at::Tensor negative_bias(const PairIdentity& queries, const PairIdentity& keys,
                         double same_meaning_weight) {
  const auto equal = [](const at::Tensor& a, const at::Tensor& b) {
    return a.unsqueeze(1).eq(b.unsqueeze(0));
  };
  const at::Tensor same =
      equal(queries.group, keys.group).logical_or(equal(queries.caption, keys.caption));
  // log(0) is the -infinity that a weight of 0 means.
  return torch::zeros(same.sizes())
      .masked_fill(equal(queries.meaning, keys.meaning), std::log(same_meaning_weight))
      .masked_fill(same, -std::numeric_limits<float>::infinity());
}

at::Tensor contrast_loss(const at::Tensor& queries, const at::Tensor& keys, const at::Tensor& queue,
                         const at::Tensor& batch_bias, const at::Tensor& queue_bias,
                         const at::Tensor& scale) {
  const int64_t count = queries.size(0);
  const auto own = torch::eye(count, batch_bias.options().dtype(torch::kBool));
  // Infinities are added, not multiplied: 0 x infinity would be the gradient of the scale.
  at::Tensor logits = torch::matmul(queries, keys.t()) * scale + batch_bias.masked_fill(own, 0);
  if (queue.defined()) {
    logits = torch::cat({logits, torch::matmul(queries, queue.t()) * scale + queue_bias}, 1);
  }
  return torch::cross_entropy_loss(logits, torch::arange(count, torch::kLong));
}

}  // namespace remomask::training
