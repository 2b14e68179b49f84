#pragma once

#include "training/training_recipe.h"

namespace remomask::lab {

// Rough arithmetic of a run in 10^9 operations, from the number of weights and
// of the positions that they are applied to: good to about a factor of two, to
// order and to weigh the parts of a plan before anything has been measured.

/// Of all training steps of a stage.
double training_cost(const training::TrainingRecipe& recipe, const std::string& stage);

/// Of generating `prompts` motions of middle length.
double trial_cost(const training::TrainingRecipe& recipe, const SamplingOptions& sampling,
                  int prompts);

}  // namespace remomask::lab
