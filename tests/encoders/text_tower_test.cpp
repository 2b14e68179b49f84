#include "encoders/text_tower.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include "remomask/error.h"

namespace remomask {
namespace {

encoders::TextEncoderConfig tiny_config() {
  encoders::TextEncoderConfig config = encoders::text_encoder_preset(ModelSize::tiny);
  config.vocabulary =
      text::train_wordpiece({"a person walks forward", "a person walks and waves"}, 300);
  return config;
}

TEST(TextTower, ResultDoesNotDependOnTheBatch) {
  at::NoGradGuard no_grad;
  torch::manual_seed(1);
  const auto tower = encoders::make_text_tower(tiny_config());
  tower->eval();
  const std::vector<std::string> captions = {"a person walks", "waves",
                                             "a person walks forward and waves and walks again"};
  const encoders::TokenBatch together = tower->tokenize(captions);
  const encoders::TextStates all = tower->encode(together.ids, together.mask);
  for (size_t i = 0; i < captions.size(); ++i) {
    const encoders::TokenBatch alone = tower->tokenize({captions[i]});
    const encoders::TextStates one = tower->encode(alone.ids, alone.mask);
    const auto row = static_cast<int64_t>(i);
    EXPECT_TRUE(torch::allclose(one.pooled[0], all.pooled[row], 1e-4, 1e-4));
    EXPECT_TRUE(
        torch::allclose(one.states[0], all.states[row].slice(0, 0, alone.ids.size(1)), 1e-4, 1e-4));
  }
}

TEST(TextTower, ConfigBuildsTheSameTower) {
  const auto tower = encoders::make_text_tower(tiny_config());
  const auto again = encoders::make_text_tower(nlohmann::json::parse(tower->config().dump()));
  EXPECT_EQ(again->config(), tower->config());
  nlohmann::json broken = tower->config();
  broken.erase("heads");
  EXPECT_THROW(encoders::make_text_tower(broken), Error);
  broken["tower"] = "clip";
  EXPECT_THROW(encoders::make_text_tower(broken), Error);
}

TEST(TextTower, EmptyAndOverlongCaptions) {
  const auto tower = encoders::make_text_tower(tiny_config());
  EXPECT_THROW(tower->tokenize({"a person walks", " "}), Error);
  std::string text;
  while (text.size() < 10000) text += "walks ";
  const encoders::TokenBatch batch = tower->tokenize({text, "waves"});
  EXPECT_EQ(batch.ids.size(1), 64);
  EXPECT_GT(batch.dropped[0], 0);
  EXPECT_EQ(batch.dropped[1], 0);
}

}  // namespace
}  // namespace remomask
