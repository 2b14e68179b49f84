#pragma once

#include <ATen/core/Tensor.h>

namespace remomask::generator {

/// Softmax attention with two additive biases that are never expanded:
///   softmax(Q K^T / sqrt(d_h) + [position | 0] + key) V, per head.
/// q [B, n, D]; k, v [B, m, D] with m >= n, the first n keys being the tokens
/// themselves; position [H, n, n] for those; key [B, H, m] for every key. H is
/// taken from `position`, d_h = D / H. Returns [B, n, D]. Differentiable in all
/// five.
at::Tensor biased_attention(const at::Tensor& q, const at::Tensor& k, const at::Tensor& v,
                            const at::Tensor& position, const at::Tensor& key);

}  // namespace remomask::generator
