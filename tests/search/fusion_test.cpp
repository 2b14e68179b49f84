#include "search/fusion.h"

#include <gtest/gtest.h>

namespace remomask {
namespace {

std::vector<int64_t> ids(const std::vector<search::FusedId>& fused) {
  std::vector<int64_t> result;
  for (const search::FusedId& entry : fused) result.push_back(entry.id);
  return result;
}

TEST(Fusion, AddsReciprocalRanksByHand) {
  const auto fused = search::reciprocal_rank_fusion({{{10, 20, 30}, 1}, {{30, 40}, 1}});
  ASSERT_EQ(ids(fused), (std::vector<int64_t>{30, 10, 20, 40}));
  EXPECT_DOUBLE_EQ(fused[0].score, 1 / 63.0 + 1 / 61.0);
  EXPECT_DOUBLE_EQ(fused[1].score, 1 / 61.0);
  EXPECT_DOUBLE_EQ(fused[2].score, 1 / 62.0);
  EXPECT_DOUBLE_EQ(fused[3].score, 1 / 62.0);  // as clip 20, which the first ranking holds
}

TEST(Fusion, WeightsDecide) {
  const std::vector<int64_t> by_vector = {1, 2, 3}, by_words = {3};
  EXPECT_EQ(ids(search::reciprocal_rank_fusion({{by_vector, 1}, {by_words, 0}})),
            (std::vector<int64_t>{1, 2, 3}));
  // 1/61 against 1/63 + w/61: 3 leads from w = 2/63 on.
  EXPECT_EQ(ids(search::reciprocal_rank_fusion({{by_vector, 1}, {by_words, 0.031}}))[0], 1);
  EXPECT_EQ(ids(search::reciprocal_rank_fusion({{by_vector, 1}, {by_words, 0.032}}))[0], 3);
}

TEST(Fusion, BreaksTiesByTheFirstRankingThenById) {
  EXPECT_EQ(ids(search::reciprocal_rank_fusion({{{7, 5}, 1}, {{5, 7}, 1}})),
            (std::vector<int64_t>{7, 5}));
  EXPECT_EQ(ids(search::reciprocal_rank_fusion({{{}, 1}, {{9}, 1}, {{8}, 1}})),
            (std::vector<int64_t>{8, 9}));
  EXPECT_TRUE(search::reciprocal_rank_fusion({}).empty());
}

}  // namespace
}  // namespace remomask
