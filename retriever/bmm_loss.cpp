#include "retriever/bmm_loss.h"

#include <torch/nn/functional/loss.h>

#include <limits>

namespace remomask {

at::Tensor same_pairs(const PairIdentity& queries, const PairIdentity& keys) {
  return queries.group.unsqueeze(1)
      .eq(keys.group.unsqueeze(0))
      .logical_or(queries.caption.unsqueeze(1).eq(keys.caption.unsqueeze(0)))
      .logical_or(queries.meaning.unsqueeze(1).eq(keys.meaning.unsqueeze(0)));
}

at::Tensor contrast_loss(const at::Tensor& queries, const at::Tensor& keys, const at::Tensor& queue,
                         const at::Tensor& ignore_batch, const at::Tensor& ignore_queue,
                         const at::Tensor& scale) {
  constexpr float kNever = -std::numeric_limits<float>::infinity();
  const int64_t count = queries.size(0);
  const auto own = torch::eye(count, ignore_batch.options());
  // Scaled before the infinities come in: 0 x infinity would be the gradient of the scale.
  at::Tensor logits = (torch::matmul(queries, keys.t()) * scale)
                          .masked_fill(ignore_batch.logical_and(own.logical_not()), kNever);
  if (queue.defined()) {
    logits = torch::cat(
        {logits, (torch::matmul(queries, queue.t()) * scale).masked_fill(ignore_queue, kNever)}, 1);
  }
  return torch::cross_entropy_loss(logits, torch::arange(count, torch::kLong));
}

}  // namespace remomask
