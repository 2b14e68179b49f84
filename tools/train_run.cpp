#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/bounded_file.h"
#include "base/json.h"
#include "lab/variants.h"
#include "remomask/error.h"
#include "tools/train_command.h"
#include "training/evaluator_training.h"
#include "training/model_training.h"

namespace remomask::tools {

namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMaxCaptionsFile = uint64_t{1} << 29;

/// Captions of JSON Lines files ({"captions": [...], "split": ...}); those of a
/// test split are left out, as everywhere in training.
void read_more_captions(const std::string& path, std::vector<std::string>& captions) {
  const std::string content = read_bounded_file(path, kMaxCaptionsFile);
  size_t begin = 0;
  for (long line = 1; begin < content.size(); ++line) {
    const size_t end = std::min(content.find('\n', begin), content.size());
    const std::string text = content.substr(begin, end - begin);
    begin = end + 1;
    if (text.find_first_not_of(" \r\t") == std::string::npos) continue;
    try {
      const auto entry = parse_json(text);
      if (entry.value("split", "") == "test") continue;
      for (const auto& caption : entry.at("captions")) captions.push_back(caption);
    } catch (const nlohmann::json::exception& error) {
      throw FileError(path, line, "is not a line with \"captions\": " + json_reason(error));
    }
  }
}

/// The recipe with what the user wants otherwise, the same for every stage.
training::TrainingRecipe chosen_recipe(const TrainCommand& options) {
  training::TrainingRecipe recipe = training::training_recipe(parse_preset(options.preset));
  recipe.retriever_training.queues = retriever::parse_queues(options.queues);
  if (options.queue_size) recipe.retriever_training.queue_size = *options.queue_size;
  if (options.same_label_weight) {
    recipe.retriever_training.same_meaning_weight = *options.same_label_weight;
  }
  lab::apply_variant(recipe, options.variant);
  for (const std::string& stage : training::recipe_stages(recipe)) {
    training::TrainerOptions& trainer = training::stage_trainer(recipe, stage);
    training::set_stage_steps(recipe, stage, options.steps.value_or(trainer.steps));
    if (options.batch) training::set_stage_batch(recipe, stage, *options.batch);
    if (options.learning_rate) trainer.learning_rate = *options.learning_rate;
    trainer.seed = options.seed;
  }
  return recipe;
}

training::TrainingSplits load_clips(const TrainCommand& options) {
  training::TrainingSplits splits = training::load_splits(options.database, options.sources);
  for (const std::string& path : options.captions) read_more_captions(path, splits.more_captions);
  return splits;
}

/// Trains the evaluator, which is no part of a model.
void train_judge(const TrainCommand& options, const training::TrainingSplits& clips,
                 const std::string& path, const Monitor& monitor) {
  const ModelSize size = parse_preset(options.preset).size;
  training::EvaluatorTrainingOptions training(size);
  training::TrainerOptions& trainer = training.trainer;
  trainer.steps = options.steps.value_or(trainer.steps);
  trainer.learning_rate = options.learning_rate.value_or(trainer.learning_rate);
  trainer.warmup_steps = std::min(trainer.warmup_steps, std::max<int64_t>(1, trainer.steps / 10));
  trainer.seed = training.movement.seed = options.seed;
  trainer.checkpoint_path = path + ".checkpoint";
  training.batch = options.batch.value_or(training.batch);
  const nn::ModelStage stage = training::train_evaluator(
      clips.train, clips.val, evaluation::evaluator_preset(size), training, monitor);
  nn::save_model(path, {stage}, /*half=*/true);
  fs::remove(path + ".checkpoint");
  fs::remove(path + ".checkpoint.movement");
}

void print_trained(const std::string& path, Program& program) {
  if (program.json) return program.print_json({{"file", path}});
  fmt::print("{}\n", path);
}

}  // namespace

void run_train(const TrainCommand& options, Program& program) {
  const training::TrainingSplits clips = load_clips(options);
  const training::StageFile file = [&](const std::string& stage) {
    return (fs::path(options.folder) / (stage + ".safetensors")).string();
  };
  fs::create_directories(options.folder);
  if (options.stage == "evaluator") {
    train_judge(options, clips, file("evaluator"), program.monitor());
    program.finish_progress();
    return print_trained(file("evaluator"), program);
  }
  const training::TrainingRecipe recipe = chosen_recipe(options);
  const bool all = options.stage == "all";
  const std::vector<std::string> stages = training::recipe_stages(recipe);
  if (!all && std::find(stages.begin(), stages.end(), options.stage) == stages.end()) {
    throw Error("variant " + options.variant + " has no stage " + options.stage);
  }
  training::GeneratorDataCache prepared;
  for (const std::string& stage : all ? stages : std::vector{options.stage}) {
    if (all && fs::exists(file(stage))) {
      program.warn(file(stage) + " is there and is kept; remove it to train it again");
      continue;
    }
    training::train_stage(recipe, stage, file, clips, prepared, program.monitor());
  }
  if (all) training::join_stages(recipe, file, clips, file("model"), program.monitor());
  program.finish_progress();
  print_trained(file(all ? "model" : options.stage), program);
}

}  // namespace remomask::tools
