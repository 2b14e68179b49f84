#include "training/words_training.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

#include "remomask/error.h"
#include "tests/base/test_folder.h"
#include "tests/encoders/tiny_encoder.h"

namespace remomask {
namespace {

/// Eight actions with six captions each, of other words every time but one.
std::vector<db::Clip> many_clips() {
  const std::vector<std::string> actions = {"walk", "run",  "jump", "kick",
                                            "wave", "sits", "bow",  "turn"};
  const std::vector<std::string> others = {"now", "slowly", "here", "there", "again", "away"};
  std::vector<db::Clip> clips;
  for (const std::string& action : actions) {
    for (size_t i = 0; i < others.size(); ++i) {
      db::Clip clip;
      clip.name = action + std::to_string(i);
      clip.split = i < 4 ? "train" : "val";
      clip.labels = {{"actions", {action}}};
      clip.captions = {action + " " + others[i], others[(i + 1) % 6] + " " + action};
      clips.push_back(clip);
    }
  }
  return clips;
}

std::vector<std::string> all_words() {
  std::vector<std::string> words = {"house", "tree", "river", "paper"};
  for (const db::Clip& clip : many_clips()) {
    for (const std::string& caption : clip.captions) {
      const size_t blank = caption.find(' ');
      for (const std::string& word : {caption.substr(0, blank), caption.substr(blank + 1)}) {
        if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
      }
    }
  }
  return words;
}

class WordsTrainingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    torch::manual_seed(9);
    text_ = tiny_encoder_stage(all_words());
    options_.trainer.steps = 60;
    options_.trainer.warmup_steps = 5;
    options_.trainer.learning_rate = 1e-2;
    options_.adapter.rank = 4;
    options_.batch = 6;
    options_.validate_every = 30;
  }
  nn::ModelStage train(const Monitor& monitor = {}) const {
    return training::train_words(text_, training::caption_classes(many_clips(), "train"),
                                 training::caption_classes(many_clips(), "val"), options_, monitor);
  }
  static double last(const nn::ModelStage& stage, const char* figure) {
    return stage.config.at("training").at("history").back().at(figure);
  }

  nn::ModelStage text_;
  training::WordsTrainingOptions options_;
};

TEST_F(WordsTrainingTest, CaptionsOfOneKindComeTogether) {
  options_.general_weight = 0;
  const nn::ModelStage trained = train();
  EXPECT_EQ(trained.kind, encoders::kAdapterStage);
  options_.trainer.learning_rate = 1e-9;
  const nn::ModelStage untrained = train();
  EXPECT_GT(last(trained, "nearest_right"), last(untrained, "nearest_right") + 0.1);
  EXPECT_NEAR(last(untrained, "general_change"), 0, 1e-3);
}

TEST_F(WordsTrainingTest, GeneralEnglishIsKept) {
  options_.general_weight = 0;
  const double free = last(train(), "general_change");
  options_.general_weight = 200;
  EXPECT_LT(last(train(), "general_change"), 0.7 * free);
}

TEST_F(WordsTrainingTest, ResumesAsIfItHadNotStopped) {
  options_.trainer.steps = 12;
  const nn::ModelStage whole = train();
  const TestFolder folder;
  options_.trainer.checkpoint_path = folder / "words.checkpoint";
  for (int i = 0; i < 3; ++i) {
    std::stop_source stop;
    Monitor monitor;
    monitor.stop = stop.get_token();
    monitor.progress = [&](const Progress&) { stop.request_stop(); };  // after the first step
    EXPECT_THROW(train(monitor), Interrupted);
  }
  const nn::ModelStage resumed = train();
  ASSERT_EQ(resumed.tensors.size(), whole.tensors.size());
  for (const auto& [name, tensor] : whole.tensors) {
    EXPECT_TRUE(torch::equal(tensor, resumed.tensors.at(name))) << name;
  }
}

TEST_F(WordsTrainingTest, NeedsSeveralKinds) {
  std::vector<db::Clip> one = many_clips();
  one.resize(4);
  EXPECT_THROW(
      training::train_words(text_, training::caption_classes(one, "train"), {}, options_, {}),
      Error);
}

TEST(CaptionClasses, AreClipsOfOneMeaning) {
  const auto classes = training::caption_classes(many_clips(), "train");
  ASSERT_EQ(classes.size(), 8u);
  EXPECT_EQ(classes[0].actions, (std::set<std::string>{"bow"}));
  EXPECT_EQ(classes[0].clips.size(), 4u);
  EXPECT_EQ(classes[0].captions.size(), 8u);
}

TEST(CaptionClasses, WhatMayMeanTheSameIsNoNegative) {
  training::CaptionClass walk, walk_turn, old_walk, young_walk, unknown;
  walk.actions = old_walk.actions = young_walk.actions = {"walk"};
  walk_turn.actions = {"turn", "walk"};
  old_walk.style = "old";
  young_walk.style = "young";
  EXPECT_TRUE(training::may_mean_the_same(walk, walk_turn));
  EXPECT_TRUE(training::may_mean_the_same(walk_turn, walk));
  EXPECT_TRUE(training::may_mean_the_same(walk, old_walk));
  EXPECT_FALSE(training::may_mean_the_same(old_walk, young_walk));
  EXPECT_FALSE(training::may_mean_the_same(unknown, walk));
}

}  // namespace
}  // namespace remomask
