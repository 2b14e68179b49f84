#include "generator/condition.h"

#include <ATen/ops/cat.h>
#include <c10/util/Exception.h>

namespace remomask::generator {

namespace {

template <typename Combine>
Condition combine_conditions(const Combine& combine) {
  Condition result;
  result.text_states = combine(&Condition::text_states);
  result.text_mask = combine(&Condition::text_mask);
  result.text_query = combine(&Condition::text_query);
  result.hit_motion = combine(&Condition::hit_motion);
  result.hit_text = combine(&Condition::hit_text);
  result.hit_similarity = combine(&Condition::hit_similarity);
  result.hit_mask = combine(&Condition::hit_mask);
  result.hit_tokens = combine(&Condition::hit_tokens);
  result.use_text = combine(&Condition::use_text);
  result.use_retrieval = combine(&Condition::use_retrieval);
  return result;
}

}  // namespace

Condition select_condition(const Condition& condition, const at::Tensor& index) {
  return combine_conditions(
      [&](at::Tensor Condition::*field) { return (condition.*field).index_select(0, index); });
}

Condition concatenate_conditions(const Condition& first, const Condition& second) {
  TORCH_INTERNAL_ASSERT(first.text_states.size(1) == second.text_states.size(1) &&
                        first.hit_motion.size(1) == second.hit_motion.size(1) &&
                        first.hit_tokens.sizes().slice(1) == second.hit_tokens.sizes().slice(1));
  return combine_conditions([&](at::Tensor Condition::*field) {
    return at::cat({first.*field, second.*field}, 0);
  });
}

}  // namespace remomask::generator
