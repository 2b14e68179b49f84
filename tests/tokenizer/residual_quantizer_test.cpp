#include "tokenizer/residual_quantizer.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

namespace remomask {
namespace {

tokenizer::CodebookTraining plain_training() {
  tokenizer::CodebookTraining training;
  training.reset_every = 0;
  training.level_dropout = 0;
  return training;
}

tokenizer::ResidualQuantizer quantizer_with(const at::Tensor& codes, int64_t levels) {
  tokenizer::ResidualQuantizer quantizer(
      tokenizer::QuantizerOptions{levels, codes.size(0), codes.size(1), 1});
  for (int64_t level = 0; level < levels; ++level) {
    quantizer->set_codebook(level, codes.unsqueeze(0));
  }
  return quantizer;
}

TEST(ResidualQuantizer, MovingAveragesOfThreeCodes) {
  auto quantizer = quantizer_with(torch::tensor({{0.f}, {10.f}, {20.f}}), 1);
  auto training = plain_training();
  training.decay = 0.9;
  // 1 and 3 go to code 0, 12 to code 1, none to code 2.
  quantizer->train_step(torch::tensor({1.f, 3.f, 12.f}).view({1, 3, 1}), training, 1, 0);
  const auto count = quantizer->counts(0)[0], sum = quantizer->sums(0)[0].flatten();
  EXPECT_NEAR(count[0].item<double>(), 0.9 + 0.1 * 2, 1e-6);
  EXPECT_NEAR(count[1].item<double>(), 0.9 + 0.1, 1e-6);
  EXPECT_NEAR(count[2].item<double>(), 0.9, 1e-6);
  EXPECT_NEAR(sum[0].item<double>(), 0.1 * 4, 1e-6);
  EXPECT_NEAR(sum[1].item<double>(), 9 + 0.1 * 12, 1e-6);
  EXPECT_NEAR(sum[2].item<double>(), 18, 1e-6);
  const auto codes = quantizer->codebook(0)[0].flatten();
  EXPECT_NEAR(codes[0].item<double>(), 0.4 / 1.1, 1e-6);
  EXPECT_NEAR(codes[1].item<double>(), 10.2, 1e-5);
  EXPECT_NEAR(codes[2].item<double>(), 20, 1e-5);
}

TEST(ResidualQuantizer, DeadCodesComeBackWithFullState) {
  auto quantizer = quantizer_with(torch::tensor({{0.f}, {1000.f}}), 1);
  auto training = plain_training();
  training.decay = 0.5;
  training.reset_every = 4;
  training.dead_share = 0.2;
  const auto batch = torch::tensor({-1.f, 1.f, -1.f, 1.f}).view({1, 4, 1});
  for (int64_t step = 0; step < 4; ++step) quantizer->train_step(batch, training, 1, step);
  EXPECT_NEAR(quantizer->codebook(0)[0][1].item<double>(), 1000, 1e-3);
  const auto before = quantizer->counts(0)[0].clone();
  quantizer->train_step(batch, training, 1, 4);
  const double code = quantizer->codebook(0)[0][1].item<double>();
  const double count = quantizer->counts(0)[0][1].item<double>();
  EXPECT_NEAR(std::abs(code), 1, 1e-6);  // a row of the batch
  EXPECT_GT(count, before[1].item<double>());
  EXPECT_NEAR(quantizer->sums(0)[0][1].item<double>(), code * count, 1e-6);
  // The state agrees, so the next update keeps the new code in the data.
  quantizer->train_step(batch, training, 1, 5);
  EXPECT_LE(std::abs(quantizer->codebook(0)[0][1].item<double>()), 1.001);
}

TEST(ResidualQuantizer, EveryLevelLeavesLessOver) {
  torch::manual_seed(3);
  tokenizer::ResidualQuantizer quantizer(tokenizer::QuantizerOptions{4, 16, 4, 2});
  auto training = plain_training();
  training.reset_every = 10;
  const auto z = torch::randn({2, 400, 4}) * torch::tensor({3.f, 1.f, 1.f, 0.5f});
  for (int64_t step = 0; step < 60; ++step) quantizer->train_step(z, training, 1, step);
  const auto index = quantizer->encode(z);
  ASSERT_EQ(index.sizes(), (at::IntArrayRef{2, 400, 4}));
  double previous = z.square().mean().item<double>();
  for (int64_t levels = 1; levels <= 4; ++levels) {
    const double left =
        (z - quantizer->decode(index.slice(-1, 0, levels))).square().mean().item<double>();
    EXPECT_LT(left, 0.75 * previous) << levels;
    previous = left;
  }
}

TEST(ResidualQuantizer, GradientPassesOnceWhateverTheLevels) {
  for (const int64_t levels : {1, 5}) {
    torch::manual_seed(4);
    tokenizer::ResidualQuantizer quantizer(tokenizer::QuantizerOptions{levels, 8, 3, 1});
    const auto z = torch::randn({1, 20, 3}).requires_grad_();
    const auto factor = torch::randn({1, 20, 3});
    (quantizer->train_step(z, plain_training(), 1, 0).value * factor).sum().backward();
    EXPECT_TRUE(torch::allclose(z.grad(), factor)) << levels;
  }
}

TEST(ResidualQuantizer, CommitmentIsTheMeanOverLevels) {
  auto quantizer = quantizer_with(torch::tensor({{0.f}, {4.f}}), 2);
  const auto z = torch::tensor({5.f, 1.f}).view({1, 2, 1}).requires_grad_();
  const auto result = quantizer->train_step(z, plain_training(), 1, 0);
  // Level 0: 5 -> 4, 1 -> 0: errors 1, 1, mean square 1. Level 1: both 1 -> 0: again 1.
  EXPECT_NEAR(result.commitment.item<double>(), 1, 1e-6);
  EXPECT_NEAR(result.value.detach().flatten()[0].item<double>(), 4, 1e-6);
  result.commitment.backward();
  // d/dz of the mean of two levels' (z - code)^2 / 2 rows = 2 * 1 / 2 a row.
  EXPECT_NEAR(z.grad().flatten()[0].item<double>(), 1, 1e-6);
  EXPECT_NEAR(z.grad().flatten()[1].item<double>(), 1, 1e-6);
}

TEST(ResidualQuantizer, DropoutUsesFewerLevelsAsOftenAsAsked) {
  torch::manual_seed(5);
  tokenizer::ResidualQuantizer quantizer(tokenizer::QuantizerOptions{4, 8, 2, 1});
  auto training = plain_training();
  training.level_dropout = 0.4;
  const auto z = torch::randn({1, 16, 2});
  std::vector<int> seen(5, 0);
  constexpr int kSteps = 500;
  for (int64_t step = 0; step < kSteps; ++step) {
    ++seen[quantizer->train_step(z, training, 7, step).perplexity.size()];
  }
  EXPECT_EQ(seen[0], 0);
  for (int levels = 1; levels <= 3; ++levels) EXPECT_NEAR(seen[levels], 0.1 * kSteps, 25);
  EXPECT_NEAR(seen[4], 0.7 * kSteps, 45);
}

TEST(ResidualQuantizer, SampledAssignmentPrefersNearCodes) {
  torch::manual_seed(6);
  auto training = plain_training();
  training.decay = 1;  // keeps the codes where they are
  training.sample_temperature = 0.5;
  auto quantizer = quantizer_with(torch::tensor({{0.f}, {3.f}, {100.f}}), 1);
  const auto z = torch::full({1, 2000, 1}, 1.f);
  const auto value = quantizer->train_step(z, training, 1, 0).value.flatten();
  // Squared distances 1 and 4, unit 1: odds exp((4 - 1) / 0.5) = e^6 to 1.
  EXPECT_NEAR((value > 2).to(torch::kFloat).mean().item<double>(), 1 / (1 + std::exp(6)), 0.004);
  EXPECT_EQ((value > 50).sum().item<int64_t>(), 0);
}

}  // namespace
}  // namespace remomask
