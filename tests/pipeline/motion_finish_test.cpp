#include "pipeline/motion_finish.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "synthetic/procedural.h"

namespace remomask {
namespace {

/// The skeleton in its rest directions with every bone `factor` times as long.
Motion stretched_rest(double factor, double root_height) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion(2, skeleton.joints());
  for (int frame = 0; frame < 2; ++frame) {
    set_joint_position(motion, frame, 0, {0.3 * frame, root_height, 0.1});
    for (int joint = 1; joint < skeleton.joints(); ++joint) {
      set_joint_position(
          motion, frame, joint,
          joint_position(motion, frame, skeleton.parents[joint]) +
              factor * skeleton.bone_lengths[joint] * rest_direction(skeleton, joint));
    }
  }
  return motion;
}

TEST(MotionFinish, BonesGetTheirLengthsAndKeepDirections) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion = stretched_rest(1.3, 1.2);
  pipeline::impose_bone_lengths(motion, skeleton);
  const Motion expected = stretched_rest(1, 1.2);
  for (size_t i = 0; i < motion.positions.size(); ++i) {
    EXPECT_NEAR(motion.positions[i], expected.positions[i], 1e-5);
  }
}

TEST(MotionFinish, HeldFeetStandAndKeepTheBones) {
  const Skeleton& skeleton = humanml_skeleton();
  // The body stands, glides by 2 cm a frame, and one foot slides 1 cm a frame on its own.
  const Motion rest = stretched_rest(1, 0);
  const double height = -joint_position(rest, 0, skeleton.left_feet.back()).y() + 0.01;
  Motion motion(20, skeleton.joints());
  for (int t = 0; t < motion.frames; ++t) {
    for (int joint = 0; joint < motion.joints; ++joint) {
      set_joint_position(motion, t, joint,
                         joint_position(rest, 0, joint) + Vec3(0, height, 0.02 * t));
    }
    for (const int joint : skeleton.left_feet) motion.at(t, joint)[2] += 0.01f * t;
  }
  pipeline::impose_bone_lengths(motion, skeleton);
  motion::Features features(motion.frames, skeleton.feature_dim());
  for (int t = 0; t < motion.frames; ++t) {
    for (const int back : {1, 3}) features.row(t)[features.dim - back] = 1;
  }
  const auto slide = [&](const Motion& m, int toe) {
    return std::abs(joint_position(m, 19, toe).z() - joint_position(m, 0, toe).z());
  };
  const int left = skeleton.left_feet.back(), right = skeleton.right_feet.back();
  ASSERT_GT(slide(motion, right), 0.35);
  pipeline::hold_feet(motion, features, skeleton);
  EXPECT_LT(slide(motion, left), 0.02);
  EXPECT_LT(slide(motion, right), 0.02);
  for (int t = 0; t < motion.frames; ++t) {
    for (int joint = 1; joint < motion.joints; ++joint) {
      const double length =
          (joint_position(motion, t, joint) - joint_position(motion, t, skeleton.parents[joint]))
              .norm();
      EXPECT_NEAR(length, skeleton.bone_lengths[joint], 1e-4) << joint;
    }
  }
}

// A gait whose feet do not slide keeps its path; its feet, which swing low, bend a little.
TEST(MotionFinish, HoldingLeavesANaturalGaitAlmostAsItIs) {
  const Skeleton& skeleton = humanml_skeleton();
  for (const char* kind : {"walk-forward", "walk-fast", "run"}) {
    const Motion before = synthetic::make_procedural_clip(kind).motion;
    Motion held = before;
    pipeline::hold_feet(
        held, motion::extract_features_all_frames(before, skeleton, motion::FeatureMode::fixed),
        skeleton);
    double root = 0, all = 0;
    for (int t = 0; t < before.frames; ++t) {
      root = std::max(root, (joint_position(held, t, 0) - joint_position(before, t, 0)).norm());
      for (int joint = 0; joint < before.joints; ++joint) {
        all += (joint_position(held, t, joint) - joint_position(before, t, joint)).norm();
      }
    }
    all /= before.frames * before.joints;
    EXPECT_LT(root, 0.1) << kind;
    EXPECT_LT(all, 0.06) << kind;
  }
}

TEST(MotionFinish, OnlyMotionsBelowTheFloorAreRaised) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion low = stretched_rest(1, 0.5);
  const double raised = pipeline::lift_to_floor(low, skeleton);
  EXPECT_GT(raised, 0.3);
  double lowest = 1;
  for (const int joint : {7, 8, 10, 11})
    lowest = std::min(lowest, joint_position(low, 0, joint).y());
  EXPECT_NEAR(lowest, 0, 1e-6);
  EXPECT_NEAR(joint_position(low, 1, 0).x(), 0.3, 1e-6);
  Motion high = stretched_rest(1, 2);
  const Motion before = high;
  EXPECT_EQ(pipeline::lift_to_floor(high, skeleton), 0);
  EXPECT_EQ(high.positions, before.positions);
}

}  // namespace
}  // namespace remomask
