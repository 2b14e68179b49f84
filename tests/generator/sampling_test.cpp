#include "generator/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "nn/threads.h"
#include "remomask/error.h"
#include "tests/generator/condition_test_tools.h"

namespace remomask {
namespace {

struct SamplerModels {
  generator::MaskedTransformer masked{nullptr};
  generator::ResidualTransformer residual{nullptr};
  generator::Condition condition;
};

SamplerModels sampler_models() {
  torch::manual_seed(31);
  SamplerModels models;
  models.masked = generator::MaskedTransformer(small_masked_config());
  models.residual = generator::ResidualTransformer(small_residual_config());
  randomise_parameters(*models.masked, 0.15);
  randomise_parameters(*models.residual, 0.15);
  models.condition = random_condition(1, 4, 2, 12, 8);
  return models;
}

TEST(Sampling, ScheduleOfTenPasses) {
  EXPECT_EQ(generator::masked_counts(294, 10),
            (std::vector<int64_t>{294, 290, 280, 262, 238, 208, 173, 133, 91, 46}));
  EXPECT_EQ(generator::masked_counts(5, 10), (std::vector<int64_t>{5, 4, 3, 2, 1}));
  EXPECT_EQ(generator::masked_counts(1, 10), (std::vector<int64_t>{1}));
  EXPECT_EQ(generator::masked_counts(6, 1), (std::vector<int64_t>{6}));
}

TEST(Sampling, EveryCellGetsACode) {
  SamplerModels models = sampler_models();
  SamplingOptions options;
  options.correction_rounds = 1;
  options.score_noise = 1;
  const auto base = generator::sample_base(models.masked, models.condition, 7, 5, options);
  EXPECT_EQ(base.sizes(), (std::vector<int64_t>{7, 3}));
  EXPECT_GE(base.min().item<int64_t>(), 0);
  EXPECT_LT(base.max().item<int64_t>(), 16);
  const auto all = generator::sample_residual(models.residual, models.condition, base, 5, options);
  EXPECT_EQ(all.sizes(), (std::vector<int64_t>{7, 3, 4}));
  EXPECT_TRUE(torch::equal(all.select(2, 0), base));
  EXPECT_GE(all.min().item<int64_t>(), 0);
  EXPECT_LT(all.max().item<int64_t>(), 16);
}

TEST(Sampling, KnownCellsStay) {
  SamplerModels models = sampler_models();
  SamplingOptions options;
  options.correction_rounds = 2;
  generator::KnownTokens known;
  known.tokens = torch::randint(16, {6, 3}, torch::kLong);
  known.known = torch::rand({6, 3}) < 0.5;
  const auto base = generator::sample_base(models.masked, models.condition, 6, 9, options, known);
  EXPECT_TRUE(
      torch::equal(base.masked_select(known.known), known.tokens.masked_select(known.known)));
  EXPECT_LT(base.max().item<int64_t>(), 16);

  generator::KnownTokens levels{torch::randint(16, {6, 3, 4}, torch::kLong), known.known};
  levels.tokens.select(2, 0).copy_(base);
  const auto all =
      generator::sample_residual(models.residual, models.condition, base, 9, options, levels);
  const auto cells = known.known.unsqueeze(2).expand_as(all);
  EXPECT_TRUE(torch::equal(all.masked_select(cells), levels.tokens.masked_select(cells)));
  EXPECT_FALSE(torch::equal(all, levels.tokens));

  known.known = torch::ones({6, 3}, torch::kBool);
  EXPECT_TRUE(torch::equal(
      generator::sample_base(models.masked, models.condition, 6, 9, options, known), known.tokens));
  known.known = torch::ones({5, 3}, torch::kBool);
  EXPECT_THROW(generator::sample_base(models.masked, models.condition, 6, 9, options, known),
               Error);
}

TEST(Sampling, SameSeedSameResultForAnyThreads) {
  torch::manual_seed(32);
  generator::MaskedConfig config;  // base sizes: small products are never split between threads
  config.layers = 2;
  generator::MaskedTransformer masked(config);
  randomise_parameters(*masked, 0.05);
  const generator::Condition condition = random_condition(1, 9, 4, 256, 256);
  std::vector<at::Tensor> results;
  for (const int threads : {1, 4, 2}) {
    nn::set_compute_threads(threads);
    results.push_back(generator::sample_base(masked, condition, 30, 77, {}));
  }
  nn::set_compute_threads(0);
  EXPECT_TRUE(torch::equal(results[0], results[1]));
  EXPECT_TRUE(torch::equal(results[0], results[2]));
  EXPECT_FALSE(torch::equal(results[0], generator::sample_base(masked, condition, 30, 78, {})));
}

TEST(Sampling, TemperatureSpreadsTheCodes) {
  const std::vector<float> logits = {3, 2.5, 2, 1.5, 1, 0.5, 0, -1};
  const auto share_of_best = [&](double temperature, int64_t kept) {
    int best = 0;
    for (uint64_t i = 0; i < 4000; ++i) {
      best +=
          generator::sample_code(logits.data(), 8, kept, temperature, CounterRandom(3, i), 0) == 0;
    }
    return best / 4000.0;
  };
  double sum = 0;
  for (const float logit : logits) sum += std::exp(logit);
  EXPECT_NEAR(share_of_best(1, 8), std::exp(3.0) / sum, 0.025);
  EXPECT_LT(share_of_best(3, 8), share_of_best(1, 8) - 0.1);
  EXPECT_GT(share_of_best(0.3, 8), share_of_best(1, 8) + 0.1);
  EXPECT_EQ(share_of_best(0, 8), 1);
  EXPECT_EQ(share_of_best(1, 1), 1);
  std::set<int64_t> drawn;
  for (uint64_t i = 0; i < 500; ++i) {
    drawn.insert(generator::sample_code(logits.data(), 8, 3, 5, CounterRandom(4, i), 0));
  }
  EXPECT_EQ(drawn, (std::set<int64_t>{0, 1, 2}));
}

TEST(Sampling, GuidanceOneIsTheConditionalModel) {
  SamplerModels models = sampler_models();
  SamplingOptions options;
  options.steps = 1;
  options.temperature = 0;
  options.guidance = 1;
  const auto base = generator::sample_base(models.masked, models.condition, 4, 1, options);
  const torch::NoGradGuard no_grad;
  models.masked->eval();
  const auto logits = models.masked->forward(torch::full({1, 4, 3}, 16, torch::kLong),
                                             models.masked->prepare(models.condition));
  EXPECT_TRUE(torch::equal(base.reshape({12}), logits[0].argmax(1)));
}

}  // namespace
}  // namespace remomask
