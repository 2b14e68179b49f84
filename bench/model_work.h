#pragma once

#include "generator/sampling.h"
#include "generator/ssta.h"
#include "tokenizer/tokenizer.h"

namespace remomask {

/// Floating-point operations of matrix products, two for each multiply-add. Everything else in a
/// network is small in comparison and not counted.

/// The number of rows of text and hits in a condition of one sample.
struct ConditionSize {
  int64_t text_tokens;  ///< S
  int64_t hits;         ///< k, not read without retrieval
};

/// SstaStack::prepare() for one sample.
double prepare_flops(const generator::SstaConfig& config, int64_t layers,
                     const ConditionSize& condition);
/// SstaStack::forward() for one sample of `frames` token frames.
double stack_flops(const generator::SstaConfig& config, int64_t layers,
                   const ConditionSize& condition, int64_t frames);

/// The stacks inside the two transformers.
generator::SstaConfig stack_config(const generator::MaskedConfig& config);
generator::SstaConfig stack_config(const generator::ResidualConfig& config);

/// sample_base() and sample_residual() of `frames` token frames.
double sample_base_flops(const generator::MaskedConfig& config, const SamplingOptions& options,
                         const ConditionSize& condition, int64_t frames);
double sample_residual_flops(const generator::ResidualConfig& config,
                             const SamplingOptions& options, const ConditionSize& condition,
                             int64_t frames);

/// Tokenizer::encode() and decode() of 4 `frames` poses. Throws Error for a
/// tokenizer of several time scales.
double encode_flops(const tokenizer::TokenizerConfig& config, int64_t frames);
double decode_flops(const tokenizer::TokenizerConfig& config, int64_t frames);

}  // namespace remomask
