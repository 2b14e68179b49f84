#include "lab/ablation_cost.h"

#include "base/time.h"
#include "retriever/motion_encoder.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask::lab {

namespace {

// Sizes of a clip of medium length.
constexpr double kTokenFrames = 27, kWords = 10;
// A weight is used in one multiplication and one addition; the backward pass
// costs twice the forward one.
constexpr double kForward = 2, kTraining = 6;

double transformer_weights(double width, double hidden, double layers) {
  return layers * (4 * width * width + 2 * width * hidden);
}

// Of the shipped sentence encoder, without its tables: 6 layers of 384, hidden 1536.
const double kTowerWeights = transformer_weights(384, 1536, 6);

double reader_weights(const retriever::RetrieverConfig& config) {
  return transformer_weights(static_cast<double>(config.text_width),
                             static_cast<double>(config.text_hidden),
                             static_cast<double>(config.text_layers));
}

template <typename Config>
double stack_weights(const Config& config) {
  return transformer_weights(static_cast<double>(config.width), static_cast<double>(config.hidden),
                             static_cast<double>(config.layers)) +
         static_cast<double>(config.width * config.codes);
}

/// Products of all pairs of n rows in every layer.
template <typename Config>
double pair_operations(const Config& config, double rows) {
  return 2 * static_cast<double>(config.layers * config.width) * rows * rows;
}

double weights_of(const torch::nn::Module& module) {
  double count = 0;
  for (const auto& parameter : module.parameters()) count += static_cast<double>(parameter.numel());
  return count;
}

template <typename Config>
double pass_operations(const Config& config) {
  const double rows = kTokenFrames * static_cast<double>(config.rows);
  return stack_weights(config) * rows + pair_operations(config, rows);
}

}  // namespace

double training_cost(const training::TrainingRecipe& recipe, const std::string& stage) {
  const auto steps = static_cast<double>(training::stage_trainer(recipe, stage).steps);
  double operations = 0;  // of the forward pass of a step, additions not counted
  if (stage == "retriever") {
    const training::RetrieverTrainingOptions& options = recipe.retriever_training;
    // The momentum twin sees every patch and has no backward pass.
    const double patches = 4 * kTokenFrames / static_cast<double>(recipe.model.retriever.patch) *
                           (options.patch_keep + kForward / kTraining);
    operations = (weights_of(retriever::MotionEncoder(recipe.model.retriever)) * patches +
                  kWords * (reader_weights(recipe.model.retriever) * (1 + kForward / kTraining) +
                            kTowerWeights * 2 * kForward / kTraining)) *
                 static_cast<double>(options.batch);
  } else if (stage == "tokenizer") {
    operations = weights_of(*tokenizer::TokenizerNetwork(recipe.model.tokenizer)) *
                 static_cast<double>(recipe.tokenizer_training.batch_frames) / kFramesPerToken;
  } else if (stage == "masked") {
    operations =
        pass_operations(recipe.model.masked) * static_cast<double>(recipe.masked_training.batch);
  } else {
    operations = pass_operations(recipe.model.residual) *
                 static_cast<double>(recipe.residual_training.batch);
  }
  return kTraining * operations * steps / 1e9;
}

double trial_cost(const training::TrainingRecipe& recipe, const SamplingOptions& sampling,
                  int prompts) {
  const double guided = sampling.guidance == 1 ? 1 : 2;
  const auto levels = static_cast<double>(recipe.model.tokenizer.levels - 1);
  const double operations =
      pass_operations(recipe.model.masked) * guided * sampling.steps +
      pass_operations(recipe.model.residual) * 2 * levels +
      weights_of(*tokenizer::TokenizerNetwork(recipe.model.tokenizer)) * kTokenFrames;
  return kForward * operations * prompts / 1e9;
}

}  // namespace remomask::lab
