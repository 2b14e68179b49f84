#include "pipeline/physical.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "remomask/error.h"
#include "tests/evaluation/evaluator_test_tools.h"

namespace remomask {
namespace {

void move_frame(Motion& motion, int frame, const Vec3& way) {
  for (int joint = 0; joint < motion.joints; ++joint) {
    set_joint_position(motion, frame, joint, joint_position(motion, frame, joint) + way);
  }
}

PhysicalMetrics measure(const Motion& motion) {
  return pipeline::measure_physical(motion, humanml_skeleton());
}

TEST(Physical, StandingBodyIsPerfect) {
  const PhysicalMetrics metrics = measure(standing_body(5));
  EXPECT_TRUE(metrics.finite);
  EXPECT_NEAR(metrics.bone_length_max, 0, 1e-5);
  EXPECT_NEAR(metrics.penetration_max, 0, 1e-6);
  EXPECT_EQ(metrics.floating_share, 0);
  EXPECT_EQ(metrics.contact_share, 1);
  EXPECT_NEAR(metrics.foot_skate, 0, 1e-5);
  EXPECT_NEAR(metrics.jerk, 0, 1e-2);
}

TEST(Physical, FramesWithBothFeetInTheAirFloat) {
  Motion motion = standing_body(4);
  move_frame(motion, 2, Vec3(0, 0.11, 0));
  move_frame(motion, 3, Vec3(0, 0.09, 0));
  EXPECT_NEAR(measure(motion).floating_share, 0.25, 1e-9);
}

TEST(Physical, OneBoneTenPercentTooLong) {
  Motion motion = standing_body(4);
  set_joint_position(motion, 2, 21,
                     joint_position(motion, 2, 19) +
                         1.1 * (joint_position(motion, 2, 21) - joint_position(motion, 2, 19)));
  const PhysicalMetrics metrics = measure(motion);
  EXPECT_NEAR(metrics.bone_length_max, 0.1, 1e-5);
  EXPECT_NEAR(metrics.bone_length_mean, 0.1 / (21 * 4), 1e-6);
}

TEST(Physical, BonesWithoutAUniformLengthCompareWithFrameZero) {
  Skeleton skeleton = humanml_skeleton();
  std::fill(skeleton.bone_lengths.begin(), skeleton.bone_lengths.end(), 0.);
  Motion motion = standing_body(2);
  set_joint_position(motion, 1, 21,
                     joint_position(motion, 1, 19) +
                         0.8 * (joint_position(motion, 1, 21) - joint_position(motion, 1, 19)));
  const PhysicalMetrics metrics = pipeline::measure_physical(motion, skeleton);
  EXPECT_NEAR(metrics.bone_length_max, 0.2, 1e-5);
  EXPECT_NEAR(metrics.bone_length_mean, 0.2 / (21 * 2), 1e-6);
}

TEST(Physical, OneFrameTwoCentimetresBelowTheFloor) {
  Motion motion = standing_body(4);
  move_frame(motion, 1, {0, -0.02, 0});
  const PhysicalMetrics metrics = measure(motion);
  EXPECT_NEAR(metrics.penetration_max, 0.02, 1e-6);
  EXPECT_NEAR(metrics.penetration_mean, 0.02 / 4, 1e-6);
}

TEST(Physical, SlidingFeet) {
  Motion motion = standing_body(4);
  // 2, 3 and 3 cm a frame of 50 ms: 0.4, 0.6 and 0.6 m/s; the last step is in
  // the air, where nothing slides.
  move_frame(motion, 1, {0, 0, 0.02});
  move_frame(motion, 2, {0.03, 0, 0.02});
  move_frame(motion, 3, {0.06, 0.1, 0.02});
  const PhysicalMetrics metrics = measure(motion);
  EXPECT_NEAR(metrics.contact_share, 4. / 6, 1e-9);
  EXPECT_NEAR(metrics.foot_skate, 0.5, 1e-5);
  EXPECT_NEAR(metrics.foot_skate_ratio, 0.5, 1e-9);
}

TEST(Physical, JerkOfACubicWay) {
  Motion motion = standing_body(8);
  for (int frame = 0; frame < 8; ++frame) {
    move_frame(motion, frame, {0.001 * std::pow(frame, 3), 0, 0});
  }
  // The third difference of 0.001 t^3 is 0.006 m; (1 / 20 s)^3 = 1 / 8000 s^3.
  EXPECT_NEAR(measure(motion).jerk, 48, 0.05);
}

TEST(Physical, ValuesThatAreNotFinite) {
  Motion motion = standing_body(4);
  motion.at(3, 7)[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(measure(motion).finite);
  motion.at(3, 7)[1] = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(measure(motion).finite);
}

TEST(Physical, ShortMotionsAndWrongSkeletons) {
  EXPECT_EQ(measure(standing_body(1)).contact_share, 0);
  EXPECT_THROW(measure(Motion()), Error);
  EXPECT_THROW(pipeline::measure_physical(standing_body(4), kit_skeleton()), Error);
}

TEST(Physical, SummaryLeavesBrokenMotionsOut) {
  PhysicalMetrics one, two, broken;
  one.jerk = 10;
  one.penetration_max = 0.01;
  two.jerk = 20;
  two.penetration_max = 0.03;
  broken.finite = false;
  const pipeline::PhysicalSummary summary = pipeline::summarise_physical({one, broken, two});
  EXPECT_EQ(summary.motions, 3);
  EXPECT_EQ(summary.not_finite, 1);
  EXPECT_FALSE(summary.values.finite);
  EXPECT_NEAR(summary.values.jerk, 15, 1e-12);
  EXPECT_EQ(summary.values.penetration_max, 0.03);
}

}  // namespace
}  // namespace remomask
