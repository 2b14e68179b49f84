#pragma once

#include <ATen/core/Tensor.h>

#include <cstdint>
#include <optional>
#include <vector>

#include "generator/masked_transformer.h"
#include "generator/tokenizer.h"
#include "motion/motion.h"

namespace remomask {

// A retrieved motion as the start of a token map: part of its codes stay, the
// masked transformer makes the others under the prompt.

/// What is known of a hit before its codes are asked for.
struct DraftCandidate {
  double similarity = 0;
  int frames = 0;
};

/// The candidate to follow in a motion of `frames` frames. Candidates are scored by
/// similarity x exp(-0.1 |l - l'| / max(l, l')) (the length term of ReMoDiffuse, eq. 5);
/// of those within 0.03 of the best one is drawn by the seed, so that several seeds
/// follow several motions. Nothing for no candidate of at least 8 frames.
std::optional<size_t> choose_draft(const std::vector<DraftCandidate>& candidates, int frames,
                                   uint64_t seed);

/// A motion at most `frames` frames long: resampled in time where the lengths differ by
/// at most a quarter; of a longer one the stretch of `frames` frames in which the joints
/// travel furthest.
Motion fit_length(const Motion& motion, int frames);

/// Log-probability of every base token of a map int64 [T, rows] given about half of the
/// others, text and hits: float [T, rows]. Two passes; in each the other half of the
/// cells is masked, drawn by the seed.
at::Tensor token_likelihood(MaskedTransformer model, const Condition& condition,
                            const at::Tensor& tokens, uint64_t seed);

/// The round(share x free) likeliest of the cells of `free` bool [T, rows]; equal ones
/// in the order of the map.
at::Tensor likeliest_cells(const at::Tensor& likelihood, const at::Tensor& free, double share);

}  // namespace remomask
