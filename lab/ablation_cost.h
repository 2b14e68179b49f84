#pragma once

#include "training/training_recipe.h"

namespace remomask::lab {

// Rough cost of a run in 10^9 operations, from the number of weights and of the positions that they
// are applied to. Good to about a factor of two: enough to order and weigh the parts of a plan
// before anything has been measured.

/// Cost of all training steps of a stage.
double training_cost(const training::TrainingRecipe& recipe, const std::string& stage);

/// Cost of generating `prompts` motions of medium length.
double trial_cost(const training::TrainingRecipe& recipe, const SamplingOptions& sampling,
                  int prompts);

}  // namespace remomask::lab
