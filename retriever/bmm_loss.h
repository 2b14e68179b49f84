#pragma once

#include <ATen/core/Tensor.h>

namespace remomask {

/// What makes two pairs the same thing: a pair is no negative for another one
/// of the same group (clip, windows, mirror twin), the same caption or the same
/// meaning.
struct PairIdentity {
  at::Tensor group;    ///< [N] int64
  at::Tensor caption;  ///< [N] int64, hash of the normalised caption
  at::Tensor meaning;  ///< [N] int64, hash of what the labels say; unlike for unlike groups
                       ///< where labels are missing or not to be used
};

/// [N, M] bool, true where pair m must not count as a negative for pair n.
at::Tensor same_pairs(const PairIdentity& queries, const PairIdentity& keys);

/// One direction of bidirectional momentum contrast (ReMoMask eq. 4-7):
/// cross entropy of row i of scale x [q k^T | q queue^T] with target i.
/// queries, keys [B, E] of length 1; queue [K, E] or undefined; ignore_batch
/// [B, B] (its diagonal is not read) and ignore_queue [B, K]: true removes that
/// negative. scale: 1 / temperature, scalar tensor. Mean over B.
at::Tensor contrast_loss(const at::Tensor& queries, const at::Tensor& keys, const at::Tensor& queue,
                         const at::Tensor& ignore_batch, const at::Tensor& ignore_queue,
                         const at::Tensor& scale);

}  // namespace remomask
