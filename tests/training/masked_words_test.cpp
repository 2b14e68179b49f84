#include "training/masked_words.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include "remomask/error.h"

namespace remomask {
namespace {

std::vector<std::string> grammar_captions() {
  std::vector<std::string> captions;
  for (const char* who : {"a person", "a man", "she", "the old woman"}) {
    for (const char* verb : {"walks", "runs", "jumps", "turns"}) {
      for (const char* where : {"forward", "to the left", "in a circle"}) {
        captions.push_back(std::string(who) + " " + verb + " " + where);
      }
    }
  }
  return captions;
}

TEST(MaskedWords, HidesWordsInTheRightShares) {
  encoders::TokenBatch batch;
  batch.ids = torch::full({400, 22}, 50, torch::kLong);
  batch.ids.select(1, 0).fill_(text::WordPiece::kStart);
  batch.ids.select(1, 20).fill_(text::WordPiece::kEnd);
  batch.ids.select(1, 21).fill_(text::WordPiece::kPad);
  CounterRandom random(3);
  const training::MaskedWords words = training::mask_words(batch, 1000, 0.15, random);
  const auto hidden = words.target.ge(0);
  for (const int64_t column : {0, 20, 21})
    EXPECT_FALSE(hidden.select(1, column).any().item<bool>());
  const double count = hidden.sum().item<double>();
  EXPECT_NEAR(count / (400 * 19), 0.15, 0.015);
  EXPECT_TRUE(words.target.index({hidden}).eq(50).all().item<bool>());
  EXPECT_TRUE(words.ids.index({hidden.logical_not()})
                  .eq(batch.ids.index({hidden.logical_not()}))
                  .all()
                  .item<bool>());
  const auto seen = words.ids.index({hidden});
  EXPECT_NEAR(seen.eq(text::WordPiece::kMask).sum().item<double>() / count, 0.8, 0.05);
  EXPECT_NEAR(seen.eq(50).sum().item<double>() / count, 0.1, 0.04);
}

TEST(MaskedWords, TrainingLearnsTheGrammarAndRepeatsExactly) {
  training::TextTrainingOptions options;
  options.trainer.steps = 120;
  options.trainer.learning_rate = 3e-3;
  options.trainer.warmup_steps = 10;
  options.batch = 32;
  options.validation_every = 60;
  const auto run = [&] {
    return training::train_text_encoder(
        grammar_captions(), encoders::text_encoder_preset(ModelSize::tiny), options, {});
  };
  const nn::ModelStage first = run();
  EXPECT_EQ(first.kind, "text");
  // Guessing among the 300 or so tokens would be right once in a hundred.
  EXPECT_GT(first.config["history"].back()["val_accuracy"].get<double>(), 0.3);
  const nn::ModelStage second = run();
  EXPECT_EQ(nn::stage_hash(first), nn::stage_hash(second));
  const auto tower = encoders::make_text_tower(first.config);
  nn::load_module_tensors(*tower, first.tensors, "test");
}

TEST(MaskedWords, TooFewCaptionsAreAnError) {
  EXPECT_THROW(training::train_text_encoder({"a", "b", "b"},
                                            encoders::text_encoder_preset(ModelSize::tiny), {}, {}),
               Error);
}

}  // namespace
}  // namespace remomask
