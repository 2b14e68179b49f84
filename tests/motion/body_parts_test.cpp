#include "motion/body_parts.h"

#include <gtest/gtest.h>

#include <set>

#include "remomask/error.h"

namespace remomask {
namespace {

TEST(BodyParts, EveryColumnBelongsToExactlyOnePart) {
  for (const Skeleton* skeleton : {&humanml_skeleton(), &kit_skeleton()}) {
    std::multiset<int> columns;
    for (int part = 0; part < motion::kBodyParts; ++part) {
      for (const int column : motion::part_columns(*skeleton, part)) columns.insert(column);
    }
    ASSERT_EQ(static_cast<int>(columns.size()), skeleton->feature_dim());
    int expected = 0;
    for (const int column : columns) EXPECT_EQ(column, expected++);
  }
}

TEST(BodyParts, LeftLegByHand) {
  const auto columns = motion::part_columns(humanml_skeleton(), 0);
  ASSERT_EQ(columns.size(), 50u);
  EXPECT_EQ(columns[0], 4);     // position of joint 1
  EXPECT_EQ(columns[3], 67);    // its rotation
  EXPECT_EQ(columns[9], 196);   // its velocity
  EXPECT_EQ(columns[12], 13);   // position of joint 4
  EXPECT_EQ(columns[48], 259);  // left contacts
  EXPECT_EQ(columns[49], 260);
}

TEST(BodyParts, MirrorExchangesLeftAndRight) {
  for (const Skeleton* skeleton : {&humanml_skeleton(), &kit_skeleton()}) {
    const auto& slots = motion::body_parts(*skeleton).slots;
    for (const int left : {0, 4}) {
      for (int k = 0; k < motion::kPartSlots; ++k) {
        const int joint = slots[left][k];
        EXPECT_EQ(slots[left + 1][k], joint < 0 ? joint : skeleton->mirror[joint]);
      }
    }
  }
}

TEST(BodyParts, UnknownSkeletonIsAnError) {
  Skeleton other = humanml_skeleton();
  other.parents.resize(40, 0);  // a centipede
  EXPECT_THROW(motion::body_parts(other), Error);
}

}  // namespace
}  // namespace remomask
