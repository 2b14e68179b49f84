#include "training/tokenizer_training.h"

#include <torch/types.h>
#include <torch/utils.h>

#include <cmath>

#include "base/random.h"
#include "evaluation/tokenizer_metrics.h"
#include "motion/feature_layout.h"
#include "remomask/error.h"
#include "tokenizer/tokenizer_network.h"
#include "training/window_sampler.h"

namespace remomask::training {

namespace {

constexpr uint64_t kWeightStream = 0x77656967;

std::vector<const motion::Features*> evenly_spread(
    const std::vector<const motion::Features*>& clips, size_t count) {
  if (clips.size() <= count) return clips;
  std::vector<const motion::Features*> chosen;
  for (size_t i = 0; i < count; ++i) chosen.push_back(clips[i * clips.size() / count]);
  return chosen;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

std::map<std::string, double> validation_figures(const evaluation::TokenizerMetrics& metrics) {
  std::map<std::string, double> figures = {{"mpjpe", metrics.all_levels.mpjpe},
                                           {"mpjpe_base", metrics.base_level.mpjpe},
                                           {"mpjpe_global", metrics.all_levels.global_mpjpe},
                                           {"foot_skate", metrics.all_levels.foot_skate},
                                           {"code_use", mean_of(metrics.code_use)},
                                           {"perplexity", mean_of(metrics.perplexity)}};
  for (size_t level = 0; level < metrics.code_use.size(); ++level) {
    figures["code_use_" + std::to_string(level)] = metrics.code_use[level];
  }
  return figures;
}

// What makes a run the same run, for resuming.
nlohmann::json tokenizer_run_identity(const tokenizer::TokenizerConfig& config,
                                      const TokenizerTrainingOptions& options,
                                      const std::vector<const motion::Features*>& clips) {
  int64_t frames = 0;
  for (const motion::Features* clip : clips) frames += clip->frames;
  nlohmann::json identity = options_document(options);
  identity["config"] = config;
  identity["clips"] = clips.size();
  identity["frames"] = frames;
  return identity;
}

}  // namespace

nlohmann::json options_document(const TokenizerTrainingOptions& options) {
  const tokenizer::CodebookTraining& codebooks = options.codebooks;
  return {{"loss", options.loss},
          {"commitment", options.commitment},
          {"window", options.window},
          {"batch_frames", options.batch_frames},
          {"long_share", options.long_share},
          {"codebooks",
           {{"decay", codebooks.decay},
            {"reset_every", codebooks.reset_every},
            {"dead_share", codebooks.dead_share},
            {"level_dropout", codebooks.level_dropout},
            {"sample_temperature", codebooks.sample_temperature}}}};
}

FeatureStatistics feature_statistics(const std::vector<const motion::Features*>& clips,
                                     const Skeleton& skeleton) {
  const motion::FeatureLayout layout(skeleton);
  std::vector<double> sum(layout.dim, 0), square(layout.dim, 0);
  double rows = 0;
  for (const motion::Features* clip : clips) {
    if (clip->dim != layout.dim) {
      throw Error("features have " + std::to_string(clip->dim) + " columns, the skeleton " +
                  skeleton.name + " needs " + std::to_string(layout.dim));
    }
    for (int t = 0; t < clip->frames; ++t) {
      const float* row = clip->row(t);
      for (int64_t c = 0; c < layout.dim; ++c) {
        sum[c] += row[c];
        square[c] += static_cast<double>(row[c]) * row[c];
      }
    }
    rows += clip->frames;
  }
  if (rows == 0) throw Error("feature statistics: there are no clips");
  std::vector<float> mean(layout.dim), deviation(layout.dim);
  const std::vector<int64_t> borders = {
      layout.yaw,       layout.root_velocity, layout.height,   layout.positions,
      layout.rotations, layout.velocities,    layout.contacts, layout.dim};
  for (size_t group = 0; group + 1 < borders.size(); ++group) {
    double total = 0;
    for (int64_t c = borders[group]; c < borders[group + 1]; ++c) {
      const double m = sum[c] / rows;
      mean[c] = static_cast<float>(m);
      total += std::sqrt(std::max(0.0, square[c] / rows - m * m));
    }
    const double average = total / static_cast<double>(borders[group + 1] - borders[group]);
    if (!(average > 1e-8)) {
      throw Error("feature statistics: columns " + std::to_string(borders[group]) + " to " +
                  std::to_string(borders[group + 1] - 1) + " never change; check the clips");
    }
    for (int64_t c = borders[group]; c < borders[group + 1]; ++c) {
      deviation[c] = static_cast<float>(average);
    }
  }
  return {torch::tensor(mean), torch::tensor(deviation)};
}

nn::ModelStage train_tokenizer(const std::vector<db::TrainingClip>& train,
                               const std::vector<db::TrainingClip>& val,
                               const tokenizer::TokenizerConfig& config,
                               const TokenizerTrainingOptions& options, const Monitor& monitor) {
  const auto clips = evaluation::clip_features(train);
  const auto validation_clips =
      evenly_spread(evaluation::clip_features(val), options.validation_clips);
  torch::manual_seed(mix_seed(options.trainer.seed, kWeightStream));
  tokenizer::TokenizerNetwork network(config);
  const FeatureStatistics statistics = feature_statistics(clips, network->skeleton());
  network->set_statistics(statistics.mean, statistics.deviation);
  const TokenizerLoss loss(network->skeleton(), statistics.mean, statistics.deviation,
                           options.loss);
  const WindowSampler sampler(clips, {options.window, options.batch_frames, options.long_share});

  Trainer trainer(*network, options.trainer, tokenizer_run_identity(config, options, clips));
  if (!validation_clips.empty()) {
    trainer.set_validation(options.validate_every, [&](int64_t) {
      return validation_figures(evaluation::measure_tokenizer(network, validation_clips));
    });
  }
  const uint64_t seed = options.trainer.seed;
  trainer.run(
      [&](int64_t step) {
        const auto target = network->normalise(sampler.batch(seed, step));
        const tokenizer::TokenizerOutput output =
            network->train_step(target, options.codebooks, seed, step);
        StepResult result;
        const auto reconstruction = loss(output.features, target);
        result.loss = reconstruction + options.commitment * output.quantized.commitment;
        result.figures = {{"reconstruction", reconstruction.item<double>()},
                          {"perplexity", mean_of(output.quantized.perplexity)}};
        return result;
      },
      monitor);
  nn::ModelStage stage;
  stage.kind = "tokenizer";
  stage.config = config;
  stage.config["training"] = {{"steps", options.trainer.steps},
                              {"seed", options.trainer.seed},
                              {"clips", train.size()},
                              {"history", trainer.history()}};
  stage.tensors = nn::module_tensors(*network);
  return stage;
}

}  // namespace remomask::training
