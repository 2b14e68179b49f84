#pragma once

#include <string>
#include <vector>

#include "evaluation/evaluator.h"

namespace remomask {

/// Preset tiny over the words of separable_clips().
evaluation::EvaluatorConfig tiny_evaluator_config();

/// Stage of an evaluator with random weights.
nn::ModelStage untrained_evaluator_stage(uint64_t seed);

/// The uniform body stands with straight legs; its left toe and ankle are on
/// the floor, the right ones 10.2 mm above (the right leg is shorter).
Motion standing_body(int frames);

}  // namespace remomask
