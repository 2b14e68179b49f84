#pragma once

#include <cstdint>

namespace remomask::generator {

/// Sizes of one attention head of one sample, and how its rows lie in memory.
struct HeadShape {
  int64_t queries, keys, width;  ///< n, m, d_h
  int64_t padded_queries() const { return (queries + 3) / 4 * 4; }
  int64_t padded_keys() const { return (keys + 15) / 16 * 16; }
  int64_t padded_width() const { return (width + 15) / 16 * 16; }
  /// Floats of working memory that a call needs.
  int64_t scratch() const {
    return padded_width() * (3 * padded_queries() + 4 * padded_keys()) +
           padded_queries() * padded_keys();
  }
};

/// Rows of `width` floats, `stride` floats apart.
struct ConstRows {
  const float* data;
  int64_t stride;
};
struct Rows {
  float* data;
  int64_t stride;
};

/// out = softmax(q k^T / sqrt(width) + [position | 0] + key) v. `position` is
/// [n, n], `key` [m]; `weights`, [padded n, padded m], receives the softmax and
/// is needed for the gradient. Single-threaded, on the widest vectors of the
/// processor.
void attend_head(const HeadShape& shape, ConstRows q, ConstRows k, ConstRows v,
                 const float* position, const float* key, float* weights, Rows out, float* scratch);

/// Gradients of attend_head. `grad_position` [n, n] is added to, the others are set.
void attend_head_backward(const HeadShape& shape, ConstRows grad_out, ConstRows q, ConstRows k,
                          ConstRows v, const float* weights, Rows grad_q, Rows grad_k, Rows grad_v,
                          float* grad_position, float* grad_key, float* scratch);

}  // namespace remomask::generator
