#pragma once

#include <string>
#include <vector>

#include "evaluation/evaluator.h"

namespace remomask {

/// Preset tiny over the words of separable_clips().
EvaluatorConfig tiny_evaluator_config();

/// Stage of an evaluator with random weights.
ModelStage untrained_evaluator_stage(uint64_t seed);

}  // namespace remomask
