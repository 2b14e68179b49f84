#pragma once

#include <ATen/core/Tensor.h>

namespace remomask::generator {

/// What steers the generator, for B samples. k may be 0 (no retrieval at all).
struct Condition {
  at::Tensor text_states;     ///< [B, S, text_width] token states of the text tower
  at::Tensor text_mask;       ///< [B, S] bool
  at::Tensor text_query;      ///< [B, E] pooled text vector
  at::Tensor hit_motion;      ///< [B, k, E] R_m: motion vectors of the retrieved clips
  at::Tensor hit_text;        ///< [B, k, E] R_t: vectors of their captions
  at::Tensor hit_similarity;  ///< [B, k] cosine of query and hit
  at::Tensor hit_mask;        ///< [B, k] bool, false where there is no (good) hit
  at::Tensor hit_tokens;      ///< [B, s, T_h, rows] int64: base tokens of the best s <= k hits, -1
                              ///< where no frame is; s = 0: the hits are vectors only
  at::Tensor use_text;        ///< [B] bool; false: the learned null text token stands in
  at::Tensor use_retrieval;   ///< [B] bool; false: the learned null retrieval token stands in
};

/// The same condition for rows `index` ([N] int64) of the batch.
Condition select_condition(const Condition& condition, const at::Tensor& index);

/// Conditions of two batches one after the other (same S, k).
Condition concatenate_conditions(const Condition& first, const Condition& second);

}  // namespace remomask::generator
