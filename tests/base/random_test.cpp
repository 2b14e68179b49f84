#include "base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace remomask {
namespace {

TEST(CounterRandomTest, DependsOnSeedStreamAndCounterAlone) {
  CounterRandom a(5, 2), b(5, 2);
  const uint64_t first = a.bits();
  const uint64_t second = a.bits();
  EXPECT_EQ(b.bits_at(1), second);
  EXPECT_EQ(b.bits(), first);
  EXPECT_NE(CounterRandom(5, 3).bits_at(0), first);
  EXPECT_NE(CounterRandom(6, 2).bits_at(0), first);
}

TEST(CounterRandomTest, PhiloxKnownAnswer) {
  // Philox 4x32-10 with counter 0 and key 0 (known-answer file of Random123):
  // 6627e8d5 e169c58d bc57ac4c 9b00dbd8.
  EXPECT_EQ(CounterRandom(0, 0).bits_at(0), 0xe169c58d6627e8d5ull);
}

TEST(CounterRandomTest, UniformAndNormalHaveTheirMoments) {
  CounterRandom random(11);
  double sum = 0, square = 0, normal_sum = 0, normal_square = 0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double u = random.uniform();
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    square += u * u;
    const double n = random.normal();
    normal_sum += n;
    normal_square += n * n;
  }
  EXPECT_NEAR(sum / kCount, 0.5, 0.003);
  EXPECT_NEAR(square / kCount, 1.0 / 3, 0.003);
  EXPECT_NEAR(normal_sum / kCount, 0, 0.01);
  EXPECT_NEAR(normal_square / kCount, 1, 0.015);
}

TEST(CounterRandomTest, PermutationHoldsEveryNumberOnce) {
  CounterRandom random(3);
  const auto order = random.permutation(1000);
  EXPECT_EQ(std::set<size_t>(order.begin(), order.end()).size(), 1000u);
  EXPECT_EQ(*std::max_element(order.begin(), order.end()), 999u);
  EXPECT_NE(order, CounterRandom(4).permutation(1000));
}

TEST(CounterRandomTest, BelowCoversItsRangeEvenly) {
  CounterRandom random(9);
  std::vector<int> counts(7, 0);
  for (int i = 0; i < 70000; ++i) ++counts[random.below(7)];
  for (const int count : counts) EXPECT_NEAR(count, 10000, 400);
}

}  // namespace
}  // namespace remomask
