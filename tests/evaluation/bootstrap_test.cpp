#include "evaluation/bootstrap.h"

#include <gtest/gtest.h>

#include <numeric>

#include "remomask/error.h"

namespace remomask {
namespace {

evaluation::SampleStatistic mean_of(const std::vector<double>& values) {
  return [&values](const std::vector<size_t>& sample) {
    double sum = 0;
    for (const size_t i : sample) sum += values[i];
    return std::vector<double>{sum / static_cast<double>(sample.size())};
  };
}

TEST(Bootstrap, TwoItemsByHand) {
  // The mean of two draws from {0, 1} is 0, 1/2, 1 with probability 1/4, 1/2, 1/4.
  const std::vector<double> values = {0, 1};
  const auto wide = evaluation::bootstrap_intervals({2}, mean_of(values), {2000, 0.95, 0});
  ASSERT_EQ(wide.size(), 1u);
  EXPECT_DOUBLE_EQ(wide[0].low, 0);
  EXPECT_DOUBLE_EQ(wide[0].high, 1);
  const auto narrow = evaluation::bootstrap_intervals({2}, mean_of(values), {2000, 0.4, 0});
  EXPECT_DOUBLE_EQ(narrow[0].low, 0.5);
  EXPECT_DOUBLE_EQ(narrow[0].high, 0.5);
}

TEST(Bootstrap, MeanOfManyItemsIsNormal) {
  std::vector<double> values(400);
  for (size_t i = 0; i < values.size(); i += 2) values[i] = 1;
  const auto interval =
      evaluation::bootstrap_intervals({values.size()}, mean_of(values), {4000, 0.95, 0})[0];
  EXPECT_NEAR(interval.low, 0.5 - 1.96 * 0.025, 0.004);
  EXPECT_NEAR(interval.high, 0.5 + 1.96 * 0.025, 0.004);
}

TEST(Bootstrap, DrawsInsideStrata) {
  const auto statistic = [](const std::vector<size_t>& sample) {
    EXPECT_EQ(sample.size(), 4u);
    EXPECT_EQ(sample[0], 0u);
    for (size_t i = 1; i < 4; ++i) EXPECT_TRUE(sample[i] >= 1 && sample[i] <= 3);
    return std::vector<double>{static_cast<double>(sample[0])};
  };
  EXPECT_EQ(evaluation::bootstrap_intervals({1, 3}, statistic, {50, 0.9, 5})[0].high, 0);
}

TEST(Bootstrap, DependsOnTheSeedAlone) {
  std::vector<double> values(100);
  std::iota(values.begin(), values.end(), 0.0);
  const auto low = [&](uint64_t seed) {
    return evaluation::bootstrap_intervals({100}, mean_of(values), {100, 0.95, seed})[0].low;
  };
  EXPECT_EQ(low(3), low(3));
  EXPECT_NE(low(3), low(4));
}

TEST(Bootstrap, WithoutResamplesOrItemsThereIsNoInterval) {
  const std::vector<double> values = {1};
  EXPECT_TRUE(evaluation::bootstrap_intervals({1}, mean_of(values), {0, 0.95, 0}).empty());
  EXPECT_TRUE(evaluation::bootstrap_intervals({0}, mean_of(values), {10, 0.95, 0}).empty());
  EXPECT_THROW(evaluation::bootstrap_intervals({1}, mean_of(values), {-1, 0.95, 0}), Error);
  EXPECT_THROW(evaluation::bootstrap_intervals({1}, mean_of(values), {10, 1, 0}), Error);
}

TEST(Bootstrap, QuantilesInterpolate) {
  EXPECT_DOUBLE_EQ(evaluation::sorted_quantile({1, 2, 4}, 0), 1);
  EXPECT_DOUBLE_EQ(evaluation::sorted_quantile({1, 2, 4}, 0.25), 1.5);
  EXPECT_DOUBLE_EQ(evaluation::sorted_quantile({1, 2, 4}, 0.75), 3);
  EXPECT_DOUBLE_EQ(evaluation::sorted_quantile({1, 2, 4}, 1), 4);
  EXPECT_DOUBLE_EQ(evaluation::sorted_quantile({7}, 0.975), 7);
}

}  // namespace
}  // namespace remomask
