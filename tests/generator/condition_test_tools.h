#pragma once

#include <torch/types.h>

#include "generator/condition.h"
#include "generator/masked_transformer.h"
#include "generator/residual_transformer.h"

namespace remomask {

/// Random condition of B samples with S text tokens and k hits, all present,
/// which are vectors only.
inline generator::Condition random_condition(int64_t batch, int64_t text_tokens, int64_t hits,
                                             int64_t text_width, int64_t embedding_width) {
  const auto unit = [](const at::Tensor& x) { return x / x.norm(2, -1, true).clamp_min(1e-9); };
  generator::Condition condition;
  condition.text_states = torch::randn({batch, text_tokens, text_width});
  condition.text_mask = torch::ones({batch, text_tokens}, torch::kBool);
  condition.text_query = unit(torch::randn({batch, embedding_width}));
  condition.hit_motion = unit(torch::randn({batch, hits, embedding_width}));
  condition.hit_text = unit(torch::randn({batch, hits, embedding_width}));
  condition.hit_similarity = torch::rand({batch, hits});
  condition.hit_mask = torch::ones({batch, hits}, torch::kBool);
  condition.hit_tokens = torch::zeros({batch, 0, 0, 1}, torch::kLong);
  condition.use_text = torch::ones({batch}, torch::kBool);
  condition.use_retrieval = torch::ones({batch}, torch::kBool);
  return condition;
}

/// The same with token maps [frames, rows] of random codes for the best `hits`.
inline generator::Condition with_hit_tokens(generator::Condition condition, int64_t hits,
                                            int64_t frames, int64_t rows, int64_t codes) {
  condition.hit_tokens =
      torch::randint(codes, {condition.text_mask.size(0), hits, frames, rows}, torch::kLong);
  return condition;
}

inline generator::Condition to_double(generator::Condition condition) {
  for (at::Tensor* field : {&condition.text_states, &condition.text_query, &condition.hit_motion,
                            &condition.hit_text, &condition.hit_similarity}) {
    *field = field->to(torch::kDouble);
  }
  return condition;
}

inline generator::MaskedConfig small_masked_config() {
  generator::MaskedConfig config;
  config.preset = "test";
  config.rows = 3;
  config.codes = 16;
  config.width = 32;
  config.heads = 2;
  config.layers = 2;
  config.hidden = 64;
  config.dropout = 0;
  config.text_width = 12;
  config.embedding_width = 8;
  config.max_hits = 2;
  config.sequence_hits = 1;
  return config;
}

inline generator::ResidualConfig small_residual_config() {
  generator::ResidualConfig config;
  config.preset = "test";
  config.rows = 3;
  config.levels = 4;
  config.codes = 16;
  config.width = 32;
  config.heads = 2;
  config.layers = 2;
  config.hidden = 64;
  config.dropout = 0;
  config.text_width = 12;
  config.embedding_width = 8;
  return config;
}

/// Retrieval values start at zero; tests of the retrieval path need others.
inline void randomise_parameters(torch::nn::Module& module, double deviation) {
  const torch::NoGradGuard no_grad;
  for (auto& parameter : module.parameters()) parameter.normal_(0, deviation);
}

/// Share of the energy of x [B, n, D] that differs between the tokens of a sample.
inline double token_energy(const at::Tensor& x) {
  const auto centred = x - x.mean(1, /*keepdim=*/true);
  return (centred.square().sum() / x.square().sum()).item<double>();
}

}  // namespace remomask
