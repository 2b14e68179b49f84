#include "training/training_recipe.h"

#include <algorithm>

#include "remomask/error.h"

namespace remomask::training {

namespace {

bool has_published_size(ModelSize size) {
  return size == ModelSize::paper || size == ModelSize::momask;
}

TokenizerTrainingOptions tokenizer_training_preset(ModelSize size) {
  TokenizerTrainingOptions options;
  if (size == ModelSize::tiny) {
    options.trainer.steps = 120;
    options.trainer.learning_rate = 2e-3;
    options.batch_frames = 512;
    options.validate_every = 60;
  } else if (size == ModelSize::small) {
    options.trainer.steps = 2000;
    options.trainer.learning_rate = 2e-3;
    options.batch_frames = 1024;
  } else if (has_published_size(size)) {
    options.trainer.steps = 350000;
    options.trainer.learning_rate = 2e-4;
    options.trainer.warmup_steps = 2000;
    options.trainer.ema_decay = 0.999;
    options.batch_frames = 256 * options.window;
  }
  return options;
}

TransformerTrainingOptions transformer_preset(ModelSize size, const char* stage, int64_t base_steps,
                                              int64_t small_steps) {
  TransformerTrainingOptions options;
  options.trainer.stage_name = stage;
  options.trainer.steps = base_steps;
  options.batch = 32;
  options.trainer.learning_rate = 6e-4;
  options.trainer.warmup_steps = 100;
  options.trainer.ema_decay = 0.99;
  if (size == ModelSize::tiny) {
    options.trainer.steps = 60;
    options.trainer.learning_rate = 2e-3;
    options.batch = 16;
    options.validate_every = 30;
  } else if (size == ModelSize::small) {
    options.trainer.steps = small_steps;
    options.trainer.learning_rate = 1e-3;
    options.batch = 16;
  } else if (has_published_size(size)) {
    options.trainer.steps = 180000;
    options.trainer.learning_rate = 2e-4;
    options.trainer.warmup_steps = 2000;
    options.trainer.ema_decay = 0.999;
    options.batch = size == ModelSize::paper ? 256 : 64;
  }
  return options;
}

nlohmann::json trainer_description(const TrainerOptions& options) {
  return {{"steps", options.steps},
          {"learning_rate", options.learning_rate},
          {"warmup_steps", options.warmup_steps},
          {"final_rate", options.final_rate},
          {"weight_decay", options.weight_decay},
          {"beta1", options.beta1},
          {"beta2", options.beta2},
          {"clip_norm", options.clip_norm},
          {"ema_decay", options.ema_decay},
          {"seed", options.seed}};
}

nlohmann::json training_description(const TrainingRecipe& recipe, const std::string& stage) {
  if (stage == "retriever") return options_document(recipe.retriever_training);
  if (stage == "tokenizer") return options_document(recipe.tokenizer_training);
  return options_document(stage == "masked" ? recipe.masked_training : recipe.residual_training);
}

nlohmann::json stage_config(const TrainingRecipe& recipe, const std::string& stage) {
  if (stage == "retriever") return recipe.model.retriever;
  if (stage == "tokenizer") return recipe.model.tokenizer;
  if (stage == "masked") return recipe.model.masked;
  return recipe.model.residual;
}

}  // namespace

TrainingRecipe training_recipe(const Preset& preset) {
  TrainingRecipe recipe;
  recipe.preset = preset_name(preset);
  recipe.model = model_preset(preset);
  const ModelSize size = preset.size;
  recipe.retriever_training = RetrieverTrainingOptions(size);
  recipe.tokenizer_training = tokenizer_training_preset(size);
  recipe.masked_training = transformer_preset(size, "masked", 5600, 2800);
  recipe.residual_training = transformer_preset(size, "residual", 1500, 1500);
  return recipe;
}

std::vector<std::string> recipe_stages(const TrainingRecipe& recipe) {
  std::vector<std::string> stages = {"retriever", "tokenizer", "masked"};
  if (recipe.model.tokenizer.levels > 1) stages.push_back("residual");
  return stages;
}

const TrainerOptions& stage_trainer(const TrainingRecipe& recipe, const std::string& stage) {
  if (stage == "retriever") return recipe.retriever_training.trainer;
  if (stage == "tokenizer") return recipe.tokenizer_training.trainer;
  if (stage == "masked") return recipe.masked_training.trainer;
  if (stage == "residual") return recipe.residual_training.trainer;
  throw Error("there is no stage \"" + stage + "\"; use retriever, tokenizer, masked or residual");
}

TrainerOptions& stage_trainer(TrainingRecipe& recipe, const std::string& stage) {
  return const_cast<TrainerOptions&>(
      stage_trainer(static_cast<const TrainingRecipe&>(recipe), stage));
}

void set_stage_steps(TrainingRecipe& recipe, const std::string& stage, int64_t steps) {
  TrainerOptions& trainer = stage_trainer(recipe, stage);
  trainer.steps = steps;
  trainer.warmup_steps = std::min(trainer.warmup_steps, std::max<int64_t>(1, steps / 10));
}

void set_stage_batch(TrainingRecipe& recipe, const std::string& stage, int64_t clips) {
  stage_trainer(recipe, stage);  // refuses unknown stages
  if (stage == "retriever") recipe.retriever_training.batch = clips;
  if (stage == "tokenizer") {
    recipe.tokenizer_training.batch_frames = clips * recipe.tokenizer_training.window;
  }
  if (stage == "masked") recipe.masked_training.batch = clips;
  if (stage == "residual") recipe.residual_training.batch = clips;
}

nlohmann::json stage_description(const TrainingRecipe& recipe, const std::string& stage) {
  return {{"stage", stage},
          {"config", stage_config(recipe, stage)},
          {"trainer", trainer_description(stage_trainer(recipe, stage))},
          {"training", training_description(recipe, stage)}};
}

}  // namespace remomask::training
