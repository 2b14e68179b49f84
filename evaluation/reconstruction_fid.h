#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "evaluation/evaluator.h"
#include "tokenizer/tokenizer.h"

namespace remomask::evaluation {

/// Frechet distance of reconstructed motions to the original ones.
struct ReconstructionFid {
  double all_levels = 0, base_level = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReconstructionFid, all_levels, base_level)

/// Encodes and decodes clips (features in the tokenizer's mode) at their true
/// length, a multiple of 4; shorter ones than 4 frames are left out. Both sides
/// go through joint positions, so that the evaluator reads what a viewer sees.
/// Throws Error for fewer than two clips.
ReconstructionFid measure_reconstruction_fid(const Evaluator& evaluator,
                                             const tokenizer::Tokenizer& tokenizer,
                                             const std::vector<const motion::Features*>& clips);

}  // namespace remomask::evaluation
