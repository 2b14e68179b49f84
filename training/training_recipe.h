#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "generator/sampling.h"
#include "training/presets.h"
#include "training/retriever_training.h"
#include "training/tokenizer_training.h"
#include "training/transformer_training.h"

namespace remomask::training {

/// Everything that decides what training makes of given clips: the sizes and
/// options of all stages, and how the model is sampled unless one says otherwise.
struct TrainingRecipe {
  std::string preset;
  std::string variant = "full";  ///< see variants.h
  ModelConfig model;
  RetrieverTrainingOptions retriever_training;
  TokenizerTrainingOptions tokenizer_training;
  TransformerTrainingOptions masked_training, residual_training;
  SamplingOptions sampling;
};

/// The recipe of a preset.
TrainingRecipe training_recipe(const Preset& preset);

/// The stages of the recipe in the order of training: retriever, tokenizer, masked, and residual
/// unless there is one level only.
std::vector<std::string> recipe_stages(const TrainingRecipe& recipe);

/// How a stage is trained.
TrainerOptions& stage_trainer(TrainingRecipe& recipe, const std::string& stage);
const TrainerOptions& stage_trainer(const TrainingRecipe& recipe, const std::string& stage);

/// Sets what a user may choose for a stage. Warm-up is at most a tenth of the run.
void set_stage_steps(TrainingRecipe& recipe, const std::string& stage, int64_t steps);
void set_stage_batch(TrainingRecipe& recipe, const std::string& stage, int64_t clips);

/// All that the recipe says about one stage, without the stages it builds on.
/// Equal documents and equal data give equal weights.
nlohmann::json stage_description(const TrainingRecipe& recipe, const std::string& stage);

}  // namespace remomask::training
