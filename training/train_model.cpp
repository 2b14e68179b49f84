#include <algorithm>
#include <filesystem>

#include "base/preset.h"
#include "nn/threads.h"
#include "remomask/error.h"
#include "remomask/training.h"
#include "training/model_training.h"

namespace remomask {

TrainReport train_model(const TrainOptions& options, const Monitor& monitor) {
  namespace fs = std::filesystem;
  nn::set_compute_threads(options.threads);
  const training::TrainingSplits clips = training::load_splits(options.database);
  training::TrainingRecipe recipe = training::training_recipe(parse_preset(options.preset));
  const training::StageFile file = [&](const std::string& stage) {
    return (fs::path(options.folder) / (stage + ".safetensors")).string();
  };
  fs::create_directories(options.folder);
  training::GeneratorDataCache prepared;
  for (const std::string& stage : training::recipe_stages(recipe)) {
    if (options.steps > 0) training::set_stage_steps(recipe, stage, options.steps);
  }
  for (const std::string& stage : training::recipe_stages(recipe)) {
    if (fs::exists(file(stage))) continue;
    training::train_stage(recipe, stage, file, clips, prepared, monitor);
  }
  training::join_stages(recipe, file, clips, file("model"), monitor);
  return {file("model")};
}

}  // namespace remomask
