#include "training/token_loss.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/generator/condition_test_tools.h"

namespace remomask {
namespace {

TEST(TokenLoss, EqualsHandComputedCrossEntropy) {
  const auto logits = torch::tensor({1.f, 2.f, 0.f, 0.f, 0.f, 3.f}).reshape({1, 2, 3});
  const auto targets = torch::tensor({1, 0}, torch::kLong).reshape({1, 2, 1});
  const double first = -2 + std::log(std::exp(1) + std::exp(2) + 1);
  const double second = std::log(1 + 1 + std::exp(3));
  const training::TokenLoss both = training::token_loss(logits, targets);
  EXPECT_NEAR(both.loss.item<double>(), (first + second) / 2, 1e-6);
  EXPECT_EQ(both.accuracy, 0.5);
  const training::TokenLoss one =
      training::token_loss(logits, torch::tensor({-1, 0}, torch::kLong).reshape({1, 2, 1}));
  EXPECT_NEAR(one.loss.item<double>(), second, 1e-6);
  EXPECT_EQ(one.targets, 1);
  EXPECT_EQ(
      training::token_loss(logits, torch::full({1, 2, 1}, -1, torch::kLong)).loss.item<double>(),
      0);
}

// Two clips of three and two frames, two rows, three levels. The token of
// frame f, row r, level l of clip b is 100 b + 10 f + 3 r + l.
at::Tensor numbered_tokens() {
  auto tokens = torch::empty({2, 3, 2, 3}, torch::kLong);
  for (int64_t b = 0; b < 2; ++b) {
    for (int64_t f = 0; f < 3; ++f) {
      for (int64_t r = 0; r < 2; ++r) {
        for (int64_t l = 0; l < 3; ++l) tokens[b][f][r][l] = 100 * b + 10 * f + 3 * r + l;
      }
    }
  }
  return tokens;
}

TEST(TokenLoss, ResidualTargetsAreTheTokensOfTheLevelByHand) {
  const auto level = torch::tensor({2L, 1L});
  auto frame_mask = torch::ones({2, 3}, torch::kBool);
  frame_mask[1][2] = false;
  const auto expected = torch::tensor({2L, 5L, 12L, 15L, 22L, 25L,          // clip 0, level 2
                                       101L, 104L, 111L, 114L, -1L, -1L});  // clip 1, level 1
  EXPECT_TRUE(training::residual_targets(numbered_tokens(), level, frame_mask)
                  .equal(expected.reshape({2, 3, 2})));
  const auto unpadded = training::residual_targets(numbered_tokens(), level, {});
  EXPECT_TRUE(unpadded[1][2].equal(torch::tensor({121L, 124L})));
}

// A projection table that is zero but for one code gives the logits (0 .. a .. 0), so that
// the loss of every level is a cross entropy made by hand.
TEST(TokenLoss, ResidualLossOfAModelByHand) {
  const torch::NoGradGuard no_grad;
  torch::manual_seed(31);
  generator::ResidualTransformer model(small_residual_config());
  model->eval();
  const auto tables = model->named_parameters()["tables"];
  // Level 1: no code has a direction, so all 16 are equally likely. Level 2 too,
  // but for code 5 of row 1.
  tables[1].zero_();
  tables[2].zero_();
  tables[2][1][5].normal_();
  const auto tokens = torch::full({2, 2, 3, 4}, 5, torch::kLong);
  const auto level = torch::tensor({1L, 2L});
  const auto logits =
      model->forward(tokens, level, model->prepare(random_condition(2, 4, 0, 12, 8)));
  const auto targets = training::residual_targets(tokens, level, {});
  const auto first = training::token_loss(logits.slice(0, 0, 1), targets.slice(0, 0, 1));
  EXPECT_NEAR(first.loss.item<double>(), std::log(16), 1e-6);
  double expected = 0;
  for (int64_t cell = 0; cell < 6; ++cell) {
    double a = 0;
    if (cell % 3 == 1) {
      a = logits[1][cell][5].item<double>();
      EXPECT_GT(std::abs(a), 1e-2);
    }
    expected += std::log(std::exp(a) + 15) - a;
  }
  const auto second = training::token_loss(logits.slice(0, 1, 2), targets.slice(0, 1, 2));
  EXPECT_NEAR(second.loss.item<double>(), expected / 6, 1e-5);
  const auto both = training::token_loss(logits, targets);
  EXPECT_NEAR(both.loss.item<double>(), (std::log(16) + expected / 6) / 2, 1e-5);
}

}  // namespace
}  // namespace remomask
