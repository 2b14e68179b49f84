#include "motion/features.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "motion/canonical.h"
#include "remomask/error.h"
#include "tests/motion/support.h"

namespace remomask {

using std::numbers::pi;
using testing_support::largest_difference;
using testing_support::make_statue;
using testing_support::make_walker;
using testing_support::moved;

namespace {

constexpr motion::FeatureMode kBothModes[] = {motion::FeatureMode::official,
                                              motion::FeatureMode::fixed};

double largest_feature_difference(const motion::Features& a, const motion::Features& b,
                                  int first_row = 0, int first_column = 0, int last_column = 263) {
  EXPECT_EQ(a.frames, b.frames);
  double largest = 0;
  for (int t = first_row; t < a.frames; ++t) {
    for (int c = first_column; c < last_column; ++c) {
      largest = std::max<double>(largest, std::abs(a.row(t)[c] - b.row(t)[c]));
    }
  }
  return largest;
}

/// A walker that turns to and fro without getting near half a turn.
Motion winding_walker(int frames) {
  return make_walker(frames, [](int t) { return 0.9 * std::sin(0.05 * t); });
}

}  // namespace

TEST(Features, HandComputedRowOfATranslatedStatue) {
  Motion motion = make_statue(2, [](int) { return 0.0; });
  for (int j = 0; j < 22; ++j) motion.at(1, j)[0] += 0.03f;
  const Skeleton& skeleton = humanml_skeleton();
  for (const motion::FeatureMode mode : kBothModes) {
    const motion::Features f = motion::extract_features(motion, skeleton, mode);
    ASSERT_EQ(f.frames, 1);
    const float* row = f.row(0);
    EXPECT_NEAR(row[0], 0, 1e-6);
    EXPECT_NEAR(row[1], 0.03, 1e-6);
    EXPECT_NEAR(row[2], 0, 1e-6);
    EXPECT_NEAR(row[3], 0.93, 1e-6);
    EXPECT_NEAR(row[4], 0.6 * skeleton.bone_lengths[1], 1e-6);
    EXPECT_NEAR(row[5], 0.93 - 0.8 * skeleton.bone_lengths[1], 1e-6);
    for (int j = 0; j < 22; ++j) EXPECT_NEAR(row[193 + j * 3], 0.03, 1e-6);
    for (int c = 259; c < 263; ++c) EXPECT_EQ(row[c], 1.f);  // 0.0009 < 0.002
  }
  for (int j = 0; j < 22; ++j) motion.at(1, j)[0] += 0.02f;
  const motion::Features fast =
      motion::extract_features(motion, skeleton, motion::FeatureMode::fixed);
  for (int c = 259; c < 263; ++c) EXPECT_EQ(fast.row(0)[c], 0.f);  // 0.0025 > 0.002
}

TEST(Features, PositionsAndFeaturesDetermineEachOther) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion canonical = motion::canonicalize(winding_walker(150), skeleton);
  for (const motion::FeatureMode mode : kBothModes) {
    const motion::Features once = motion::extract_features(canonical, skeleton, mode);
    const Motion recovered = motion::recover_motion_with_next_frame(once, skeleton);
    ASSERT_EQ(recovered.frames, 150);
    const motion::Features twice = motion::extract_features(recovered, skeleton, mode);
    EXPECT_LT(largest_feature_difference(once, twice), 2e-5) << motion::feature_mode_name(mode);
    if (mode == motion::FeatureMode::official) {
      EXPECT_LT(largest_difference(recovered, canonical), 2e-5);
    }
    const Motion shorter = motion::recover_motion(once, skeleton);
    EXPECT_LT(largest_difference(shorter, slice(recovered, 0, 149)), 1e-9);
  }
}

TEST(Features, FixedModeRecoversTheMotionUpToAYaw) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion canonical = motion::canonicalize(winding_walker(150), skeleton);
  const Motion recovered = motion::recover_motion_with_next_frame(
      motion::extract_features(canonical, skeleton, motion::FeatureMode::fixed), skeleton);
  const motion::CanonicalOptions turn_only{false, false, true, true};
  EXPECT_LT(largest_difference(motion::canonicalize(recovered, skeleton, turn_only),
                               motion::canonicalize(canonical, skeleton, turn_only)),
            2e-5);
}

TEST(Features, AllFramesHaveARow) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion canonical = motion::canonicalize(winding_walker(40), skeleton);
  const motion::Features all =
      motion::extract_features_all_frames(canonical, skeleton, motion::FeatureMode::fixed);
  ASSERT_EQ(all.frames, 40);
  const Motion recovered = motion::recover_motion(all, skeleton);
  const motion::CanonicalOptions turn_only{false, false, true, true};
  EXPECT_LT(largest_difference(motion::canonicalize(recovered, skeleton, turn_only),
                               motion::canonicalize(canonical, skeleton, turn_only)),
            2e-5);
}

TEST(Features, OneWholeTurnFlipsOneRowInOfficialModeAndNoneInFixed) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion motion = make_statue(200, [](int t) { return 2 * pi * t / 199; });
  const motion::Features official =
      motion::extract_features(motion, skeleton, motion::FeatureMode::official);
  int positive = 0, negative = 0;
  for (int t = 85; t < 115; ++t) {
    EXPECT_NEAR(std::abs(official.row(t)[0]), pi / 199, 2e-5) << t;
    (official.row(t)[0] > 0 ? positive : negative)++;
  }
  EXPECT_EQ(std::min(positive, negative), 1);
  const motion::Features fixed =
      motion::extract_features(motion, skeleton, motion::FeatureMode::fixed);
  for (int t = 15; t < 180; ++t) EXPECT_NEAR(fixed.row(t)[0], -pi / 199, 2e-6) << t;
}

TEST(Features, FastTurnIsInTheRootOfFixedModeOnly) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion motion =
      make_statue(200, [](int t) { return 2 * pi * std::clamp((t - 90) / 20.0, 0.0, 1.0); });
  const auto turned = [&](motion::FeatureMode mode) {
    const motion::Features f = motion::extract_features(motion, skeleton, mode);
    double sum = 0, largest = 0;
    for (int t = 0; t < f.frames; ++t) {
      sum += 2 * f.row(t)[0] * 180 / pi;
      largest = std::max(largest, std::abs(sum));
    }
    return largest;
  };
  EXPECT_LT(turned(motion::FeatureMode::official), 4);
  EXPECT_NEAR(turned(motion::FeatureMode::fixed), 360, 0.1);
}

TEST(Features, FixedModeDoesNotKnowTheAbsoluteHeading) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion motion = winding_walker(120);
  const motion::Features straight =
      motion::extract_features(motion, skeleton, motion::FeatureMode::fixed);
  for (const double angle : {0.5, 2.0, 3.1, -2.9}) {
    const motion::Features turned = motion::extract_features(moved(motion, angle, {4, 0, -1}),
                                                             skeleton, motion::FeatureMode::fixed);
    EXPECT_LT(largest_feature_difference(straight, turned), 1e-5) << angle;
  }
}

TEST(Features, OfficialModeKnowsItInTheRotationsOnly) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion motion = winding_walker(120);
  const motion::Features straight =
      motion::extract_features(motion, skeleton, motion::FeatureMode::official);
  const motion::Features turned = motion::extract_features(moved(motion, 0.5, {4, 0, -1}), skeleton,
                                                           motion::FeatureMode::official);
  EXPECT_LT(largest_feature_difference(straight, turned, 1, 0, 67), 1e-5);
  EXPECT_LT(largest_feature_difference(straight, turned, 1, 193, 263), 1e-5);
  EXPECT_GT(largest_feature_difference(straight, turned, 1, 67, 193), 0.3);
}

TEST(Features, WholeWayIsFreeOfPlaceHeadingAndSize) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion motion = winding_walker(120);
  for (const motion::FeatureMode mode : kBothModes) {
    const motion::Features a =
        motion::extract_features(motion::canonicalize(motion, skeleton), skeleton, mode);
    const motion::Features b = motion::extract_features(
        motion::canonicalize(moved(motion, 1.1, {4, 2, -1}, 0.8), skeleton), skeleton, mode);
    EXPECT_LT(largest_feature_difference(a, b), 2e-5);
  }
}

TEST(Features, OfMirroredMotionAreMirroredFeatures) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion motion = winding_walker(90);
  for (const motion::FeatureMode mode : kBothModes) {
    const motion::Features plain = motion::extract_features(motion, skeleton, mode);
    const motion::Features mirrored =
        motion::extract_features(motion::mirror_motion(motion, skeleton), skeleton, mode);
    constexpr double kVector[] = {-1, 1, 1};
    constexpr double kSixD[] = {1, -1, -1, -1, 1, 1};
    for (int t = 0; t < plain.frames; ++t) {
      const float* p = plain.row(t);
      const float* m = mirrored.row(t);
      EXPECT_NEAR(m[0], -p[0], 1e-6);
      EXPECT_NEAR(m[1], -p[1], 1e-6);
      EXPECT_NEAR(m[2], p[2], 1e-6);
      EXPECT_NEAR(m[3], p[3], 1e-6);
      for (int j = 0; j < 22; ++j) {
        const int other = skeleton.mirror[j];
        for (int i = 0; i < 3; ++i) {
          EXPECT_NEAR(m[193 + j * 3 + i], kVector[i] * p[193 + other * 3 + i], 1e-6);
          if (j > 0) {
            EXPECT_NEAR(m[1 + j * 3 + i], kVector[i] * p[1 + other * 3 + i], 1e-6);
          }
        }
        for (int i = 0; j > 0 && i < 6; ++i) {
          EXPECT_NEAR(m[61 + j * 6 + i], kSixD[i] * p[61 + other * 6 + i], 1e-5);
        }
      }
      for (int i = 0; i < 4; ++i) EXPECT_EQ(m[259 + i], p[259 + (i + 2) % 4]);
    }
  }
}

TEST(Features, FixedRotationsStayCloseWhenArmsAreRaisedOverhead) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion = make_statue(2, [](int) { return 0.0; });
  const auto raise = [&](int frame, double tilt) {
    for (const int j : {18, 20}) {
      set_joint_position(motion, frame, j,
                         joint_position(motion, frame, skeleton.parents[j]) +
                             skeleton.bone_lengths[j] * Vec3(std::sin(tilt), std::cos(tilt), 0));
    }
  };
  raise(0, 0.02);
  raise(1, -0.02);
  const motion::Features f =
      motion::extract_features_all_frames(motion, skeleton, motion::FeatureMode::fixed);
  for (int c = 67; c < 193; ++c) EXPECT_NEAR(f.row(0)[c], f.row(1)[c], 0.06) << c;
}

TEST(Features, KitSkeletonHasItsOwnLayout) {
  const Skeleton& skeleton = kit_skeleton();
  Motion motion(30, 21);
  for (int t = 0; t < motion.frames; ++t) {
    for (int j = 0; j < 21; ++j) {
      set_joint_position(motion, t, j,
                         Vec3(30 * std::sin(j + 0.05 * t), 500 + 20 * j, 3 * t + 10 * std::cos(j)));
    }
  }
  for (const motion::FeatureMode mode : kBothModes) {
    const motion::Features f = motion::extract_features(motion, skeleton, mode);
    EXPECT_EQ(f.dim, 251);
    const Motion again = motion::recover_motion_with_next_frame(f, skeleton);
    EXPECT_EQ(again.joints, 21);
    EXPECT_NEAR(joint_position(again, 7, 20).y(), joint_position(motion, 7, 20).y(), 1e-3);
  }
}

TEST(Features, RefusesWhatItCannotUse) {
  const Skeleton& skeleton = humanml_skeleton();
  const auto extract = [&](const Motion& motion) {
    motion::extract_features(motion, skeleton, motion::FeatureMode::fixed);
  };
  EXPECT_THROW(extract(make_walker(1)), Error);
  EXPECT_THROW(extract(Motion(10, 21)), Error);
  Motion broken = make_walker(5);
  broken.at(3, 4)[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(extract(broken), Error);
  EXPECT_THROW(motion::recover_motion(motion::Features(4, 251), skeleton), Error);
  EXPECT_THROW(motion::parse_feature_mode("offical"), Error);
  EXPECT_EQ(motion::parse_feature_mode("fixed"), motion::FeatureMode::fixed);
}

}  // namespace remomask
