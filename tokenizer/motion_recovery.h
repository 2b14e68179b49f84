#pragma once

#include <ATen/core/Tensor.h>

#include "remomask/skeleton.h"

namespace remomask::tokenizer {

/// Differentiable recover_from_ric: unnormalised features [B, T, 12 J - 1] ->
/// world positions of the joints [B, T, J, 3]. The root path is integrated from
/// the origin, facing +Z; the same numbers as recover_motion().
at::Tensor recover_positions(const at::Tensor& features, const Skeleton& skeleton);

/// Positions in the frame of the root: joint 0 at (0, height, 0), the others as
/// stored: [B, T, 12 J - 1] -> [B, T, J, 3].
at::Tensor local_positions(const at::Tensor& features, const Skeleton& skeleton);

/// Lengths of the bones that end in joints 1..J-1: [B, T, J, 3] -> [B, T, J-1].
at::Tensor bone_lengths(const at::Tensor& positions, const Skeleton& skeleton);

}  // namespace remomask::tokenizer
