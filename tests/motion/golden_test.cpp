#include <gtest/gtest.h>

#include <cmath>

#include "formats/npy.h"
#include "motion/canonical.h"
#include "motion/features.h"
#include "motion/vector.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::largest_difference;
using testing_support::shared_data;

/// HumanML3D's published sample 012314.
class Golden : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string vectors = shared_data("golden/new_joint_vecs_012314.npy");
    const std::string joints = shared_data("golden/new_joints_012314.npy");
    if (vectors.empty() || joints.empty()) GTEST_SKIP() << "the shared data is not here";
    features_ = motion::Features(170, 263);
    features_.values = formats::read_npy(vectors).values;
    joints_ = Motion(170, 22);
    joints_.positions = formats::read_npy(joints).values;
  }

  void expect_same_features(const motion::Features& found) const {
    ASSERT_EQ(found.frames, features_.frames);
    for (int t = 0; t < found.frames; ++t) {
      for (int c = 0; c < 259; ++c) {
        ASSERT_NEAR(found.row(t)[c], features_.row(t)[c], 2e-5) << "row " << t << " column " << c;
      }
      for (int c = 259; c < 263; ++c) ASSERT_EQ(found.row(t)[c], features_.row(t)[c]);
    }
  }

  const Skeleton& skeleton_ = humanml_skeleton();
  motion::Features features_;
  Motion joints_;
};

TEST_F(Golden, RecoversThePublishedJoints) {
  EXPECT_LT(largest_difference(motion::recover_motion(features_, skeleton_), joints_), 1e-5);
}

TEST_F(Golden, ExtractsThePublishedFeatures) {
  const Motion motion = motion::recover_motion_with_next_frame(features_, skeleton_);
  expect_same_features(motion::extract_features(motion, skeleton_, motion::FeatureMode::official));
}

TEST_F(Golden, ReproducesThemThroughTheWholeWayFromAMovedScaledClip) {
  const Motion motion = motion::recover_motion_with_next_frame(features_, skeleton_);
  const Motion raw = testing_support::moved(motion, 0.7, {3, 0.5, -2}, 1.3);
  expect_same_features(motion::extract_features(motion::canonicalize(raw, skeleton_), skeleton_,
                                                motion::FeatureMode::official));
}

TEST_F(Golden, FixedModeDiffersWhereTheHistoricalFacingIsWrong) {
  const Motion motion = motion::recover_motion_with_next_frame(features_, skeleton_);
  const motion::Features fixed =
      motion::extract_features(motion, skeleton_, motion::FeatureMode::fixed);
  double largest = 0;
  for (int t = 0; t < fixed.frames; ++t) {
    for (int c = 4; c < 67; ++c) {
      largest = std::max<double>(largest, std::abs(fixed.row(t)[c] - features_.row(t)[c]));
    }
  }
  EXPECT_GT(largest, 0.1);
  EXPECT_NEAR(features_.row(0)[0], 0.10637326, 1e-6);  // the spike of frame 0
  EXPECT_LT(std::abs(fixed.row(0)[0]), 0.03);
}

TEST_F(Golden, BoneLengthsAreThoseOfTheTable) {
  for (int j = 1; j < 22; ++j) {
    for (const int t : {0, 85, 169}) {
      const double length =
          (joint_position(joints_, t, j) - joint_position(joints_, t, skeleton_.parents[j])).norm();
      EXPECT_NEAR(length, skeleton_.bone_lengths[j], 1.5e-6) << skeleton_.joint_names[j];
    }
  }
  EXPECT_NEAR(joint_position(joints_, 0, 0).y(), 0.8369993, 1e-6);
}

}  // namespace remomask
