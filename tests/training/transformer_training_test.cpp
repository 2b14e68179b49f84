#include "training/transformer_training.h"

#include <gtest/gtest.h>
#include <torch/types.h>

#include <filesystem>

#include "nn/threads.h"
#include "remomask/error.h"

namespace remomask {
namespace {

/// Clips whose rows each repeat one code: what is visible determines the rest.
/// Levels above repeat the base code plus their number.
training::GeneratorData toy_data(int64_t train_clips, int64_t val_clips) {
  torch::manual_seed(61);
  training::GeneratorData data;
  data.rows = 3;
  data.levels = 3;
  data.codes = 16;
  const auto split = [&](int64_t count) {
    training::TokenSplit result;
    for (int64_t i = 0; i < count; ++i) {
      const int64_t frames = 6 + i % 4;
      const auto base = torch::randint(16, {1, 3, 1}, torch::kLong).expand({frames, 3, 1});
      training::TokenClip clip;
      clip.tokens.push_back(torch::cat({base, (base + 1) % 16, (base + 2) % 16}, 2).contiguous());
      clip.captions = {i % 4};
      clip.first_query = i;
      clip.group = static_cast<int>(i);
      result.clips.push_back(clip);
    }
    result.hits = {torch::randint(train_clips, {count, 4}, torch::kLong), torch::rand({count, 4})};
    result.unfamiliar_hits = result.hits;
    return result;
  };
  data.captions.states = torch::randn({10, 12});
  data.captions.offsets = {0, 2, 5, 6, 10};
  data.captions.query = torch::randn({4, 8}) / 3;
  data.train = split(train_clips);
  data.val = split(val_clips);
  data.motion = torch::randn({train_clips, 8}) / 3;
  data.motion_text = torch::randn({train_clips, 8}) / 3;
  return data;
}

generator::MaskedConfig toy_masked_config() {
  generator::MaskedConfig config;
  config.width = 64;
  config.heads = 2;
  config.layers = 2;
  config.hidden = 128;
  config.dropout = 0;
  config.max_hits = 2;
  return config;
}

generator::ResidualConfig toy_residual_config() {
  generator::ResidualConfig config;
  config.width = 64;
  config.heads = 2;
  config.layers = 2;
  config.hidden = 128;
  return config;
}

training::TransformerTrainingOptions toy_options(int64_t steps) {
  training::TransformerTrainingOptions options;
  options.trainer.steps = steps;
  options.trainer.warmup_steps = 20;
  options.trainer.learning_rate = 2e-3;
  options.trainer.ema_decay = 0.95;
  options.trainer.stage_name = "toy";
  options.batch = 32;
  options.validate_every = 1000000;
  return options;
}

TEST(TransformerTraining, VisibleTokensDetermineMaskedOnes) {
  const training::GeneratorData data = toy_data(512, 64);
  const nn::ModelStage stage =
      training::train_masked(toy_masked_config(), data, toy_options(250), {});
  const auto& last = stage.config.at("history").back();
  // Rows that are masked as a whole cannot be known: chance is 1 of 16.
  EXPECT_GT(last.at("val_accuracy").get<double>(), 0.6) << last.dump();
  EXPECT_EQ(stage.config.at("text_width"), 12);
  EXPECT_EQ(stage.config.at("embedding_width"), 8);
}

TEST(TransformerTraining, ResidualModelLearnsTheLevelBelow) {
  const training::GeneratorData data = toy_data(256, 64);
  const nn::ModelStage stage =
      training::train_residual(toy_residual_config(), data, toy_options(120), {});
  const auto& last = stage.config.at("history").back();
  EXPECT_GT(last.at("val_accuracy").get<double>(), 0.6) << last.dump();
}

TEST(TransformerTraining, ResumedRunEqualsUninterrupted) {
  const training::GeneratorData data = toy_data(40, 8);
  const std::string path =
      (std::filesystem::temp_directory_path() / "remomask_transformer_resume.st").string();
  const auto check = [&](auto train) {
    std::filesystem::remove(path);
    training::TransformerTrainingOptions options = toy_options(6);
    const nn::ModelStage straight = train(options, Monitor{});
    options.trainer.checkpoint_path = path;
    std::stop_source stop;
    Monitor monitor;
    monitor.stop = stop.get_token();
    monitor.progress = [&](const Progress&) { stop.request_stop(); };
    EXPECT_THROW(train(options, monitor), Interrupted);
    ASSERT_TRUE(std::filesystem::exists(path));
    const nn::ModelStage resumed = train(options, Monitor{});
    std::filesystem::remove(path);
    ASSERT_EQ(straight.tensors.size(), resumed.tensors.size());
    for (const auto& [name, tensor] : straight.tensors) {
      EXPECT_TRUE(torch::equal(tensor, resumed.tensors.at(name))) << name;
    }
  };
  generator::MaskedConfig masked = toy_masked_config();
  masked.dropout = 0.1;
  check([&](const training::TransformerTrainingOptions& options, const Monitor& monitor) {
    return training::train_masked(masked, data, options, monitor);
  });
  check([&](training::TransformerTrainingOptions options, const Monitor& monitor) {
    options.history_corruption = 0.1;
    return training::train_residual(toy_residual_config(), data, options, monitor);
  });
}

TEST(TransformerTraining, NoClipsIsAnError) {
  EXPECT_THROW(training::train_masked(toy_masked_config(), {}, toy_options(1), {}), Error);
  EXPECT_THROW(training::train_residual(toy_residual_config(), {}, toy_options(1), {}), Error);
}

TEST(GeneratorData, BucketsHoldEveryClipOnceAndSimilarLengths) {
  const training::GeneratorData data = toy_data(100, 0);
  const auto batches = training::length_buckets(data.train.clips, 8, 3, 0);
  EXPECT_EQ(batches.size(), 13u);
  std::vector<int> seen(100, 0);
  int64_t padding = 0;
  for (const auto& batch : batches) {
    int64_t longest = 0;
    for (const size_t clip : batch) {
      ++seen[clip];
      longest = std::max(longest, data.train.clips[clip].tokens[0].size(0));
    }
    for (const size_t clip : batch) {
      padding += longest - data.train.clips[clip].tokens[0].size(0);
    }
  }
  EXPECT_EQ(seen, std::vector<int>(100, 1));
  EXPECT_LT(padding, 40);
  EXPECT_EQ(training::length_buckets(data.train.clips, 8, 3, 0), batches);
  EXPECT_NE(training::length_buckets(data.train.clips, 8, 3, 1), batches);
}

TEST(GeneratorData, ConditionsArePaddedAndMarked) {
  const training::GeneratorData data = toy_data(10, 0);
  const generator::Condition condition =
      training::make_condition(data, {{1, {{4, 0.5f}}, true, true}, {2, {}, false, true}}, 2, 2);
  EXPECT_EQ(condition.text_states.sizes(), (std::vector<int64_t>{2, 3, 12}));
  EXPECT_TRUE(torch::equal(condition.text_states[0], data.captions.states.slice(0, 2, 5)));
  EXPECT_TRUE(torch::equal(condition.text_mask.sum(1), torch::tensor({3, 1}, torch::kLong)));
  EXPECT_TRUE(torch::equal(condition.hit_motion[0][0], data.motion[4]));
  EXPECT_TRUE(torch::equal(condition.hit_text[0][0], data.motion_text[4]));
  EXPECT_EQ(condition.hit_similarity[0][0].item<float>(), 0.5f);
  const auto map = data.train.clips[4].tokens[0].select(2, 0);
  EXPECT_EQ(condition.hit_tokens.sizes(), (std::vector<int64_t>{2, 2, map.size(0), data.rows}));
  EXPECT_TRUE(torch::equal(condition.hit_tokens[0][0], map));
  EXPECT_TRUE(condition.hit_tokens[0][1].eq(-1).all().item<bool>());
  EXPECT_TRUE(condition.hit_tokens[1].eq(-1).all().item<bool>());
  EXPECT_TRUE(torch::equal(condition.hit_mask.sum(1), torch::tensor({1, 0}, torch::kLong)));
  EXPECT_TRUE(
      torch::equal(condition.use_text, torch::tensor({1, 0}, torch::kLong).to(torch::kBool)));
}

}  // namespace
}  // namespace remomask
