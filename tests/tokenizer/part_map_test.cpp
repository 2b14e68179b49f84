#include "tokenizer/part_map.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

#include "tests/tokenizer/tokenizer_test_tools.h"
#include "tokenizer/motion_recovery.h"

namespace remomask {
namespace {

TEST(PartMap, MapAndBackIsTheIdentity) {
  for (const Skeleton* skeleton : {&humanml_skeleton(), &kit_skeleton()}) {
    const tokenizer::PartMap map(*skeleton);
    const auto features = torch::randn({2, 5, skeleton->feature_dim()});
    const auto cells = map.to_map(features);
    ASSERT_EQ(cells.sizes(), (at::IntArrayRef{2, 5, 24, 12}));
    EXPECT_TRUE(map.to_features(cells).equal(features)) << skeleton->name;
    // Every column stands in one cell: nothing is there twice.
    EXPECT_EQ(map.to_map(torch::ones({skeleton->feature_dim()})).sum().item<double>(),
              skeleton->feature_dim());
  }
}

TEST(PartMap, CellsHoldWhatTheSlotSays) {
  const auto columns = torch::arange(263, torch::kFloat);
  const auto map = tokenizer::PartMap(humanml_skeleton()).to_map(columns);
  const auto cell = [&](int slot, int channel) { return map[slot][channel].item<float>(); };
  // Slot 1 is joint 4: positions 4 + 3*3, rotations 67 + 6*3, velocities 193 + 3*4.
  EXPECT_EQ(cell(1, 0), 13);
  EXPECT_EQ(cell(1, 3), 85);
  EXPECT_EQ(cell(1, 8), 90);
  EXPECT_EQ(cell(1, 9), 205);
  // Slot 8 is the root: yaw, velocity, height, contacts.
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(cell(8, i), i);
    EXPECT_EQ(cell(8, 4 + i), 259 + i);
    EXPECT_EQ(cell(8, 8 + i), 0);
  }
  // Slot 9 is joint 0: a velocity only.
  EXPECT_EQ(map[9].slice(0, 0, 9).abs().sum().item<float>(), 0);
  EXPECT_EQ(cell(9, 9), 193);
  EXPECT_EQ(map[15].abs().sum().item<float>(), 0);  // free
}

TEST(MotionRecovery, AgreesWithTheMotionRoom) {
  const motion::Features features = swinging_features(90, 3);
  const Motion motion = motion::recover_motion(features, humanml_skeleton());
  const auto rows = torch::tensor(features.values).view({1, 90, 263});
  const auto found = tokenizer::recover_positions(rows, humanml_skeleton());
  const auto expected = torch::tensor(motion.positions).view({1, 90, 22, 3});
  EXPECT_LT((found - expected).abs().max().item<double>(), 2e-5);
  EXPECT_GT((expected[0][89][0] - expected[0][0][0]).norm().item<double>(), 1.0);  // it walked
}

TEST(MotionRecovery, BoneLengthsOfTheUniformSkeleton) {
  const motion::Features features = swinging_features(30, 1);
  const auto rows = torch::tensor(features.values).view({1, 30, 263});
  const auto lengths = tokenizer::bone_lengths(tokenizer::local_positions(rows, humanml_skeleton()),
                                               humanml_skeleton());
  for (int j = 1; j < 22; ++j) {
    EXPECT_NEAR(lengths[0][17][j - 1].item<double>(), humanml_skeleton().bone_lengths[j], 1e-4);
  }
}

}  // namespace
}  // namespace remomask
