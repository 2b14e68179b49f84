#include "training/masking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace remomask {
namespace {

int64_t count_targets(const std::vector<bool>& mask) {
  return std::count(mask.begin(), mask.end(), true);
}

TEST(Masking, RandomMaskHasTheRoundedCount) {
  CounterRandom random(1);
  EXPECT_EQ(count_targets(training::draw_mask(training::MaskKind::random, 10, 6, 0.33, random)),
            20);
  EXPECT_EQ(count_targets(training::draw_mask(training::MaskKind::random, 10, 6, 1.0, random)), 60);
  EXPECT_EQ(count_targets(training::draw_mask(training::MaskKind::random, 10, 6, 0.0, random)), 1);
}

TEST(Masking, SectionIsContiguousAndWhole) {
  CounterRandom random(2);
  for (int i = 0; i < 50; ++i) {
    const auto mask = training::draw_mask(training::MaskKind::section, 10, 3, 0.4, random);
    EXPECT_EQ(count_targets(mask), 12);
    const auto first = std::find(mask.begin(), mask.end(), true) - mask.begin();
    EXPECT_EQ(first % 3, 0);
    for (int64_t cell = first; cell < first + 12; ++cell) EXPECT_TRUE(mask[cell]);
  }
}

TEST(Masking, RowsAreWholeAndNeverAll) {
  CounterRandom random(3);
  std::map<int64_t, int> sizes;
  for (int i = 0; i < 500; ++i) {
    const auto mask = training::draw_mask(training::MaskKind::rows, 7, 6, 0.5, random);
    const int64_t targets = count_targets(mask);
    ASSERT_EQ(targets % 7, 0);
    ++sizes[targets / 7];
    for (int row = 0; row < 6; ++row) {
      for (int frame = 1; frame < 7; ++frame) ASSERT_EQ(mask[frame * 6 + row], mask[row]);
    }
  }
  EXPECT_EQ(sizes.size(), 5u);
  EXPECT_EQ(sizes.begin()->first, 1);
  EXPECT_EQ(sizes.rbegin()->first, 5);
}

TEST(Masking, TimeThenSpaceHidesFramesAndThenTokens) {
  CounterRandom random(4);
  double share = 0;
  const int draws = 400;
  for (int i = 0; i < draws; ++i) {
    const auto mask = training::draw_mask(training::MaskKind::time_space, 20, 6, 0.5, random);
    int whole = 0;
    for (int frame = 0; frame < 20; ++frame) {
      whole += std::all_of(mask.begin() + frame * 6, mask.begin() + (frame + 1) * 6,
                           [](bool b) { return b; });
    }
    ASSERT_GE(whole, 10);
    share += static_cast<double>(count_targets(mask)) / 120 / draws;
  }
  EXPECT_NEAR(share, 0.75, 0.01);  // 1 - (1 - p)^2
}

TEST(Masking, KindsHaveTheirShares) {
  std::map<training::MaskKind, double> shares;
  CounterRandom random(5);
  for (int i = 0; i < 20000; ++i) shares[training::draw_mask_kind(6, random)] += 1 / 20000.0;
  EXPECT_NEAR(shares[training::MaskKind::time_space], 0.50, 0.015);
  EXPECT_NEAR(shares[training::MaskKind::random], 0.25, 0.015);
  EXPECT_NEAR(shares[training::MaskKind::rows], 0.15, 0.015);
  EXPECT_NEAR(shares[training::MaskKind::section], 0.10, 0.015);
  for (int i = 0; i < 200; ++i)
    EXPECT_NE(training::draw_mask_kind(1, random), training::MaskKind::rows);
}

TEST(Masking, CorruptionIsEightyTenTen) {
  CounterRandom random(6);
  double masked = 0, kept = 0, other = 0;
  const int draws = 40000;
  for (int i = 0; i < draws; ++i) {
    const int64_t token = training::corrupt_token(7, 256, 256, random);
    ASSERT_GE(token, 0);
    ASSERT_LE(token, 256);
    (token == 256 ? masked : token == 7 ? kept : other) += 1.0 / draws;
  }
  EXPECT_NEAR(masked, 0.80, 0.01);
  EXPECT_NEAR(kept, 0.10 + 0.10 / 256, 0.007);
  EXPECT_NEAR(other, 0.10, 0.007);
}

TEST(Masking, ConditionsAreDroppedInFourCategories) {
  CounterRandom random(7);
  double none = 0, text = 0, retrieval = 0, both = 0;
  const int draws = 40000;
  for (int i = 0; i < draws; ++i) {
    const training::ConditionDrop drop = training::draw_condition_drop(random);
    (drop.use_text        ? (drop.use_retrieval ? both : text)
     : drop.use_retrieval ? retrieval
                          : none) += 1.0 / draws;
  }
  EXPECT_NEAR(none, 0.10, 0.007);
  EXPECT_NEAR(text, 0.05, 0.005);
  EXPECT_NEAR(retrieval, 0.05, 0.005);
  EXPECT_NEAR(both, 0.80, 0.01);
}

}  // namespace
}  // namespace remomask
