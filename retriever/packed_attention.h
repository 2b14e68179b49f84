#pragma once

#include <ATen/core/Tensor.h>

#include <cstdint>
#include <vector>

namespace remomask::retriever {

/// Softmax self-attention inside sequences of different lengths that lie one
/// after the other, for G independent groups (CPU, with gradient).
/// query_key_value [G, M, 3 D]; sequence b is the rows offsets[b] up to
/// offsets[b + 1]; the last offset is M. Returns [G, M, D]. No row is padding,
/// so that short sequences cost what they are, and a sequence's result cannot
/// depend on its neighbours.
at::Tensor packed_attention(const at::Tensor& query_key_value, const std::vector<int64_t>& offsets,
                            int64_t heads);

}  // namespace remomask::retriever
