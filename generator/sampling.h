#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/random.h"
#include "generator/masked_transformer.h"
#include "generator/residual_transformer.h"
#include "remomask/generation.h"
#include "remomask/progress.h"

namespace remomask::generator {

/// How many of `count` tokens are masked before pass i = 0 .. steps-1:
/// round(count cos(pi/2 i/steps)), at least 1 and always fewer than before
/// while possible, so that every pass decides tokens.
std::vector<int64_t> masked_counts(int64_t count, int steps);

/// Cells of a map [T, rows] that generation must keep.
struct KnownTokens {
  at::Tensor tokens;  ///< int64 [T, rows], or [T, rows, levels] for the residual levels
  at::Tensor known;   ///< bool [T, rows]: these cells stay as they are
};

/// Base tokens int64 [T, rows] of one sample by iterative confidence decoding
/// (MaskGIT; MoMask 3.2). `condition` holds one sample. Each sample is a pass
/// of two (with and without condition) at its own length and draws from
/// (seed, pass, cell, code): the result does not depend on other samples.
/// Throws Error for guidance with a model that was trained without dropped
/// conditions.
at::Tensor sample_base(MaskedTransformer model, const Condition& condition, int64_t frames,
                       uint64_t seed, const SamplingOptions& options,
                       const std::optional<KnownTokens>& known = std::nullopt,
                       const Monitor& monitor = {});

/// All levels int64 [T, rows, levels] from base tokens [T, rows], level by
/// level. Levels of known cells are kept.
at::Tensor sample_residual(ResidualTransformer model, const Condition& condition,
                           const at::Tensor& base, uint64_t seed, const SamplingOptions& options,
                           const std::optional<KnownTokens>& known = std::nullopt,
                           const Monitor& monitor = {});

/// Gumbel-argmax over the `kept` largest of `count` logits at a temperature;
/// the noise of a code is number `first_counter + code` of `random`. Equal
/// logits: the smaller code goes first.
int64_t sample_code(const float* logits, int64_t count, int64_t kept, double temperature,
                    const CounterRandom& random, uint64_t first_counter);

}  // namespace remomask::generator
