#pragma once

#include <ATen/core/Tensor.h>

#include <cstdint>

namespace remomask::training {

/// Mean cross-entropy and accuracy over the entries of `targets` [B, T, rows]
/// that are not negative; logits [B, T * rows, codes].
struct TokenLoss {
  at::Tensor loss;      ///< scalar
  double accuracy = 0;  ///< share of targets whose code has the largest logit
  int64_t targets = 0;  ///< how many
};
TokenLoss token_loss(const at::Tensor& logits, const at::Tensor& targets);

/// Targets of the residual transformer (MoMask eq. 6): tokens [B, T, rows,
/// levels], level [B] in 1 .. levels - 1, frame_mask [B, T] or undefined.
/// Returns [B, T, rows]: the tokens of the sample's level, all of them, and -1
/// in frames that do not exist.
at::Tensor residual_targets(const at::Tensor& tokens, const at::Tensor& level,
                            const at::Tensor& frame_mask);

}  // namespace remomask::training
