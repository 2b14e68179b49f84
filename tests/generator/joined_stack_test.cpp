#include "generator/joined_stack.h"

#include <gtest/gtest.h>

#include "generator/sampling.h"
#include "remomask/error.h"
#include "tests/generator/condition_test_tools.h"

namespace remomask {
namespace {

generator::SstaConfig joined_config() {
  generator::SstaConfig config;
  config.rows = 2;
  config.width = 16;
  config.heads = 2;
  config.hidden = 32;
  config.dropout = 0;
  config.text_width = 12;
  config.embedding_width = 8;
  config.attention = "joined";
  return config;
}

generator::MaskedConfig joined_masked_config() {
  generator::MaskedConfig config = small_masked_config();
  config.attention = "joined";
  config.drops_conditions = false;
  return config;
}

// One block, written out: a sequence of condition rows and tokens through an
// ordinary encoder block.
TEST(JoinedStack, IsOrdinaryAttentionOverTheJoinedSequence) {
  torch::manual_seed(3);
  const generator::SstaConfig config = joined_config();
  generator::JoinedStack stack(config, 1);
  randomise_parameters(*stack, 0.3);
  stack->eval();
  const torch::NoGradGuard no_grad;
  const generator::Condition condition = random_condition(2, 4, 2, 12, 8);
  const auto cache = stack->prepare(condition);
  ASSERT_EQ(cache.size(), 1u);
  EXPECT_EQ(cache[0].keys.sizes(), (std::vector<int64_t>{2, 4 + 1 + 2 + 1, 16}));
  const auto x = torch::randn({2, 6, 16});
  std::vector<at::Tensor> stream;
  const auto out = stack->forward(x, cache, {}, &stream);
  ASSERT_EQ(stream.size(), 1u);
  EXPECT_EQ(out.sizes(), x.sizes());

  nn::EncoderBlock block(16, 2, 32, 0.0);
  for (auto& item : block->named_parameters()) {
    item.value().copy_(stack->named_parameters()["block0." + item.key()]);
  }
  block->eval();
  const auto sequence = torch::cat({cache[0].keys, x + generator::map_positions(3, 2, 16)}, 1);
  // Both hits are there, so that the null hit (the last row) is hidden.
  auto exists = torch::ones({2, 14}, torch::kBool);
  exists.select(1, 7).fill_(false);
  const auto expected = block(sequence, nn::key_mask_bias(exists)).slice(1, 8);
  EXPECT_TRUE(torch::allclose(stream[0], expected, 1e-5, 1e-5));
}

TEST(JoinedStack, EveryWeightGetsAGradient) {
  torch::manual_seed(4);
  generator::MaskedTransformer model(joined_masked_config());
  generator::Condition condition = with_hit_tokens(random_condition(2, 4, 2, 12, 8), 1, 6, 3, 16);
  condition.use_text[1] = false;
  condition.use_retrieval[1] = false;
  const auto tokens = torch::randint(16, {2, 5, 3}, torch::kLong);
  model->forward(tokens, model->prepare(condition)).square().sum().backward();
  for (const auto& item : model->named_parameters()) {
    ASSERT_TRUE(item.value().grad().defined()) << item.key();
    EXPECT_GT(item.value().grad().abs().max().item<float>(), 0) << item.key();
  }
}

TEST(JoinedStack, AloneEqualsPaddedBatch) {
  const torch::NoGradGuard no_grad;
  torch::manual_seed(5);
  generator::MaskedTransformer model(joined_masked_config());
  randomise_parameters(*model, 0.2);
  model->eval();
  const auto tokens = torch::randint(16, {2, 7, 3}, torch::kLong);
  auto frame_mask = torch::ones({2, 7}, torch::kBool);
  frame_mask[1].slice(0, 4).fill_(false);
  generator::Condition condition = with_hit_tokens(random_condition(2, 6, 2, 12, 8), 1, 5, 3, 16);
  condition.text_mask[1].slice(0, 2).fill_(false);
  const auto together = model->forward(tokens, model->prepare(condition), frame_mask);
  generator::Condition one = generator::select_condition(condition, torch::tensor({1}));
  one.text_states = one.text_states.slice(1, 0, 2);
  one.text_mask = one.text_mask.slice(1, 0, 2);
  const auto alone = model->forward(tokens[1].slice(0, 0, 4).unsqueeze(0), model->prepare(one));
  EXPECT_LT((together[1].slice(0, 0, 12) - alone[0]).abs().max().item<float>(), 1e-4f);
}

TEST(JoinedStack, SaysInItsFileWhatItIs) {
  torch::manual_seed(6);
  generator::MaskedTransformer model(joined_masked_config());
  model->eval();
  const nn::ModelStage stage = generator::masked_stage(model);
  EXPECT_EQ(stage.config.at("attention"), "joined");
  EXPECT_EQ(stage.config.at("drops_conditions"), false);
  generator::MaskedTransformer loaded = generator::load_masked(stage);
  const auto tokens = torch::randint(16, {1, 4, 3}, torch::kLong);
  const generator::Condition condition = random_condition(1, 4, 2, 12, 8);
  EXPECT_TRUE(torch::equal(model->forward(tokens, model->prepare(condition)),
                           loaded->forward(tokens, loaded->prepare(condition))));
  generator::ResidualConfig upper = small_residual_config();
  upper.attention = "joined";
  EXPECT_EQ(
      generator::load_residual(generator::residual_stage(generator::ResidualTransformer(upper)))
          ->config()
          .attention,
      "joined");
  nn::ModelStage unknown = stage;
  unknown.config["attention"] = "sparse";
  EXPECT_THROW(generator::load_masked(unknown), Error);
  // Files from before these choices hold neither word.
  nn::ModelStage old = generator::masked_stage(generator::MaskedTransformer(small_masked_config()));
  old.config.erase("attention");
  old.config.erase("drops_conditions");
  EXPECT_EQ(generator::load_masked(old)->config().attention, "ssta");
  EXPECT_TRUE(generator::load_masked(old)->config().drops_conditions);
}

TEST(JoinedStack, WithoutDroppedConditionsThereIsNoGuidance) {
  torch::manual_seed(7);
  generator::MaskedTransformer model(joined_masked_config());
  const generator::Condition condition = random_condition(1, 4, 2, 12, 8);
  SamplingOptions options;
  EXPECT_THROW(generator::sample_base(model, condition, 4, 1, options), Error);
  options.guidance = 1;
  EXPECT_EQ(generator::sample_base(model, condition, 4, 1, options).sizes(),
            (std::vector<int64_t>{4, 3}));
}

}  // namespace
}  // namespace remomask
