#pragma once

#include <string>
#include <vector>

#include "training/training_recipe.h"

namespace remomask::lab {

/// One row of the papers' tables: what is left out or exchanged, with everything else equal.
struct ModelVariant {
  std::string name;
  std::string meaning;
};

/// The variants with fixed names, "full" first.
const std::vector<ModelVariant>& model_variants();

/// Finds a variant: one of model_variants(), "levels-N" (N levels of the tokenizer, 1 .. 8) or
/// "quantizer-dropout-P" (P percent, 0 .. 90). Throws Error for another name.
ModelVariant find_variant(const std::string& name);

/// Turns the recipe of a preset into that of a variant. What changes is part of the configs that
/// model files hold. Throws Error for an unknown name, and for a preset that is a baseline of its
/// own (momask).
void apply_variant(training::TrainingRecipe& recipe, const std::string& name);

}  // namespace remomask::lab
