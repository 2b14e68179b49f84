#pragma once

#include <ATen/core/Tensor.h>

namespace remomask::training {

/// What makes two pairs the same thing: a pair is no negative for another one
/// of the same group (clip, windows, mirror twin) or the same caption, and a weak
/// one where only the meaning is the same.
struct PairIdentity {
  at::Tensor group;    ///< [N] int64
  at::Tensor caption;  ///< [N] int64, hash of the normalised caption
  at::Tensor meaning;  ///< [N] int64, hash of what the labels say; unlike for unlike groups
                       ///< where labels are missing or not to be used
};

/// [N, M] float, what is added to the logit of pair m as a negative for pair n:
/// -infinity where it must not count, log(same_meaning_weight) where only the
/// meaning is the same (a weight of 1 / c makes c repetitions weigh as one
/// negative; 0: they do not count, 1: in full), else 0.
at::Tensor negative_bias(const PairIdentity& queries, const PairIdentity& keys,
                         double same_meaning_weight);

/// One direction of bidirectional momentum contrast (ReMoMask eq. 4-7):
/// cross entropy of row i of scale x [q k^T | q queue^T] with target i.
/// queries, keys [B, E] of length 1; queue [K, E] or undefined; batch_bias
/// [B, B] (its diagonal is not read) and queue_bias [B, K] as of negative_bias().
/// scale: 1 / temperature, scalar tensor. Mean over B.
at::Tensor contrast_loss(const at::Tensor& queries, const at::Tensor& keys, const at::Tensor& queue,
                         const at::Tensor& batch_bias, const at::Tensor& queue_bias,
                         const at::Tensor& scale);

}  // namespace remomask::training
