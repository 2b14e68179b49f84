#include "tokenizer/tokenizer.h"

#include <gtest/gtest.h>
#include <torch/torch.h>
#include <unistd.h>

#include <filesystem>

#include "evaluation/tokenizer_metrics.h"
#include "nn/threads.h"
#include "remomask/error.h"
#include "tests/tokenizer/tokenizer_test_tools.h"
#include "tokenizer/tokenizer_network.h"
#include "training/tokenizer_training.h"

namespace remomask {
namespace {

std::string temporary_path(const std::string& name) {
  return (std::filesystem::temp_directory_path() /
          ("remomask_tokenizer_" + name + std::to_string(::getpid()) + ".safetensors"))
      .string();
}

training::TokenizerTrainingOptions short_training(int64_t steps) {
  training::TokenizerTrainingOptions options;
  options.trainer.steps = steps;
  options.trainer.warmup_steps = 2;
  options.trainer.learning_rate = 2e-3;
  options.codebooks.reset_every = 2;
  options.window = 32;
  options.batch_frames = 128;
  return options;
}

bool same_tensors(const nn::TensorMap& a, const nn::TensorMap& b) {
  if (a.size() != b.size()) return false;
  for (const auto& [name, tensor] : a) {
    if (b.count(name) == 0 || !tensor.equal(b.at(name))) return false;
  }
  return true;
}

// One short training that several tests look at.
const nn::ModelStage& trained_stage() {
  static const nn::ModelStage stage = training::train_tokenizer(
      swinging_clips({40, 61, 70, 100, 33}), {}, small_tokenizer_config(), short_training(6), {});
  return stage;
}

TEST(Tokenizer, ShapesForEveryLength) {
  const tokenizer::Tokenizer tokenizer(trained_stage());
  for (const int frames : {4, 5, 7, 8, 50, 101}) {
    const auto tokens = tokenizer.encode(swinging_features(frames, 1));
    ASSERT_EQ(tokens.sizes(), (at::IntArrayRef{frames / 4, 6, 3}));
    EXPECT_EQ(tokens.scalar_type(), at::kLong);
    for (const int64_t levels : {1, 2, 3}) {
      const motion::Features back = tokenizer.decode(tokens.slice(-1, 0, levels));
      EXPECT_EQ(back.frames, frames / 4 * 4);
      EXPECT_EQ(back.dim, 263);
    }
  }
}

TEST(Tokenizer, RefusesWhatItCannotRead) {
  const tokenizer::Tokenizer tokenizer(trained_stage());
  EXPECT_THROW(tokenizer.encode(swinging_features(3, 1)), Error);
  EXPECT_THROW(tokenizer.encode(motion::Features(8, 251)), Error);
  EXPECT_THROW(tokenizer.decode(torch::zeros({2, 6, 4}, torch::kLong)), Error);
  EXPECT_THROW(tokenizer.decode(torch::full({2, 6, 3}, 16, torch::kLong)), Error);
  EXPECT_THROW(tokenizer.decode(torch::zeros({2, 6, 3})), Error);
  nn::ModelStage other = trained_stage();
  other.kind = "retriever";
  EXPECT_THROW(tokenizer::Tokenizer{other}, Error);
  other = trained_stage();
  other.tensors.erase(other.tensors.begin());
  EXPECT_THROW(tokenizer::Tokenizer{other}, Error);
}

TEST(Tokenizer, AClipAloneAndInABatchGivesTheSameTokens) {
  const tokenizer::Tokenizer tokenizer(trained_stage());
  std::vector<motion::Features> clips;
  for (const int frames : {40, 64, 41, 80, 64, 43, 64}) {
    clips.push_back(swinging_features(frames, static_cast<int>(clips.size())));
  }
  std::vector<const motion::Features*> pointers;
  for (const motion::Features& clip : clips) pointers.push_back(&clip);
  const auto together = tokenizer.encode(pointers);
  for (size_t i = 0; i < clips.size(); ++i) {
    EXPECT_TRUE(together[i].equal(tokenizer.encode(clips[i]))) << i;
  }
}

TEST(Tokenizer, ALoadedModelIsTheSavedOne) {
  const std::string path = temporary_path("model");
  nn::save_model(path, {trained_stage()});
  const nn::ModelStage loaded = nn::load_stage(path, "tokenizer");
  std::filesystem::remove(path);
  EXPECT_TRUE(same_tensors(loaded.tensors, trained_stage().tensors));
  const tokenizer::Tokenizer before(trained_stage()), after(loaded);
  EXPECT_EQ(before.hash(), after.hash());
  const motion::Features clip = swinging_features(60, 2);
  const auto tokens = before.encode(clip);
  EXPECT_TRUE(tokens.equal(after.encode(clip)));
  EXPECT_EQ(before.decode(tokens).values, after.decode(tokens).values);
}

TEST(TokenizerTraining, AResumedRunEqualsAnUninterruptedOne) {
  const std::string path = temporary_path("checkpoint");
  const auto clips = swinging_clips({40, 61, 70, 100, 33});
  training::TokenizerTrainingOptions options = short_training(6);
  options.trainer.checkpoint_path = path;
  // Every run reports its first step, which stops it: one step a run.
  for (int run = 0; run < 5; ++run) {
    std::stop_source stop;
    Monitor monitor;
    monitor.stop = stop.get_token();
    monitor.progress = [&](const Progress&) { stop.request_stop(); };
    EXPECT_THROW(training::train_tokenizer(clips, {}, small_tokenizer_config(), options, monitor),
                 Interrupted);
  }
  const nn::ModelStage resumed =
      training::train_tokenizer(clips, {}, small_tokenizer_config(), options, {});
  std::filesystem::remove(path);
  EXPECT_TRUE(same_tensors(resumed.tensors, trained_stage().tensors));
  EXPECT_TRUE(resumed.tensors.count("quantizer.count") == 1 &&
              resumed.tensors.count("quantizer.initialised") == 1);
}

TEST(TokenizerTraining, ResidualLevelsAreUsedAndFourClipsAreLearnt) {
  const auto clips = swinging_clips({64, 64, 64, 64});
  tokenizer::TokenizerConfig config = small_tokenizer_config();
  config.codes = 32;
  config.widths = {48};
  nn::set_compute_threads(1);  // so small a network gains nothing from more
  training::TokenizerTrainingOptions options = short_training(500);
  options.trainer.learning_rate = 4e-3;
  options.trainer.warmup_steps = 20;
  options.codebooks.reset_every = 10;
  options.window = 64;
  options.batch_frames = 256;
  const nn::ModelStage stage = training::train_tokenizer(clips, clips, config, options, {});
  tokenizer::TokenizerNetwork network(config);
  nn::load_module_tensors(*network, stage.tensors, "test");
  network->eval();
  const evaluation::TokenizerMetrics metrics =
      evaluation::measure_tokenizer(network, evaluation::clip_features(clips));
  nn::set_compute_threads(0);
  EXPECT_EQ(metrics.clips, 4);
  EXPECT_EQ(metrics.frames, 256);
  EXPECT_LT(metrics.all_levels.mpjpe, 25);
  EXPECT_LT(metrics.all_levels.mpjpe, metrics.base_level.mpjpe);
  EXPECT_GT(metrics.code_use[0], 0.2);
  const nlohmann::json written = metrics;
  EXPECT_EQ(written["code_use"].size(), 3u);
  EXPECT_NEAR(stage.config["training"]["history"].back()["mpjpe"].get<double>(),
              metrics.all_levels.mpjpe, 1e-3);
}

TEST(TokenizerNetwork, OneRowAndOtherLayoutsWorkAlike) {
  torch::manual_seed(2);
  std::vector<tokenizer::TokenizerConfig> configs(4, small_tokenizer_config());
  configs[0].rows = 1;  // the layout of MoMask
  configs[0].widths = {16, 16, 16};
  configs[0].blocks = {0, 2, 2};
  configs[1].widths = {12, 16};
  configs[1].blocks = {1, 1};
  configs[2].per_row_weights = configs[2].per_row_codebooks = false;
  configs[2].mixer_width = configs[2].smooth_width = 0;
  configs[3].skeleton = "kit";
  for (const tokenizer::TokenizerConfig& config : configs) {
    tokenizer::TokenizerNetwork network(config);
    const int64_t dim = network->skeleton().feature_dim();
    const auto input = torch::randn({2, 24, dim});
    const tokenizer::TokenizerOutput output = network->train_step(input, {}, 1, 0);
    ASSERT_EQ(output.features.sizes(), input.sizes());
    output.features.square().mean().backward();
    for (const auto& parameter : network->named_parameters()) {
      EXPECT_TRUE(parameter.value().grad().defined()) << parameter.key();
    }
    network->eval();
    const auto tokens = network->tokens(input);
    ASSERT_EQ(tokens.sizes(), (at::IntArrayRef{2, 6, config.rows, config.levels}));
    EXPECT_EQ(network->from_tokens(tokens).sizes(), input.sizes());
  }
}

TEST(TokenizerNetwork, ContradictingSizesAreRefused) {
  auto config = small_tokenizer_config();
  config.rows = 3;
  EXPECT_THROW(tokenizer::TokenizerNetwork{config}, Error);
  config = small_tokenizer_config();
  config.blocks = {1, 2};
  EXPECT_THROW(tokenizer::TokenizerNetwork{config}, Error);
  config = small_tokenizer_config();
  config.skeleton = "horse";
  EXPECT_THROW(tokenizer::TokenizerNetwork{config}, Error);
}

TEST(TokenizerMetrics, ErrorsOfHandMadeBodies) {
  const Skeleton& skeleton = humanml_skeleton();
  const auto target = torch::rand({1, 1, 22, 3}).expand({2, 10, 22, 3}).contiguous();
  evaluation::ReconstructionSums shifted(skeleton);
  shifted.add(target + torch::tensor({0.2f, 0.f, 0.f}), target);
  EXPECT_NEAR(shifted.errors().mpjpe, 0, 1e-3);
  EXPECT_NEAR(shifted.errors().global_mpjpe, 200, 1e-3);
  EXPECT_NEAR(shifted.errors().bone_length, 0, 1e-3);

  auto moved = target.clone();
  moved.select(2, 21) += torch::tensor({0.f, 0.3f, 0.4f});  // one of 22 joints, 0.5 m
  evaluation::ReconstructionSums joint(skeleton);
  joint.add(moved, target);
  EXPECT_NEAR(joint.errors().mpjpe, 500.0 / 22, 1e-3);
  EXPECT_NEAR(joint.errors().global_mpjpe, 500.0 / 22, 1e-3);
  EXPECT_NEAR(joint.errors().foot_skate, 0, 1e-3);

  // All four feet slide 10 mm a frame where the original stands.
  auto sliding = target.clone();
  sliding.select(-1, 2) += (torch::arange(10) * 0.01).view({1, 10, 1});
  evaluation::ReconstructionSums feet(skeleton);
  feet.add(sliding, target);
  EXPECT_NEAR(feet.errors().foot_skate, 10, 1e-2);
  evaluation::ReconstructionSums both(skeleton);
  both.add(sliding, target);
  both.add(target, target);
  EXPECT_NEAR(both.errors().foot_skate, 5, 1e-2);
}

TEST(FeatureStatistics, GroupsShareADeviation) {
  const auto clips = swinging_clips({32, 32, 40, 32});
  const training::FeatureStatistics statistics =
      training::feature_statistics(evaluation::clip_features(clips), humanml_skeleton());
  EXPECT_EQ(statistics.deviation[70].item<double>(), statistics.deviation[190].item<double>());
  EXPECT_NE(statistics.deviation[4].item<double>(), statistics.deviation[3].item<double>());
  double height = 0, square = 0, rows = 0;
  for (const db::TrainingClip& clip : clips) {
    for (int t = 0; t < clip.features.frames; ++t, ++rows) {
      height += clip.features.row(t)[3];
      square += std::pow(clip.features.row(t)[3], 2);
    }
  }
  height /= rows;
  EXPECT_NEAR(statistics.mean[3].item<double>(), height, 1e-5);
  EXPECT_NEAR(statistics.deviation[3].item<double>(), std::sqrt(square / rows - height * height),
              1e-4);
  EXPECT_THROW(training::feature_statistics({}, humanml_skeleton()), Error);
  motion::Features still(20, 263);  // nothing ever changes
  EXPECT_THROW(training::feature_statistics({&still}, humanml_skeleton()), Error);
}

}  // namespace
}  // namespace remomask
