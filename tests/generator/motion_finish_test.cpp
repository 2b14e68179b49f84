#include "generator/motion_finish.h"

#include <gtest/gtest.h>

namespace remomask {
namespace {

/// The skeleton in its rest directions with every bone `factor` times as long.
Motion stretched_rest(double factor, double root_height) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion(2, skeleton.joints());
  for (int frame = 0; frame < 2; ++frame) {
    motion.set(frame, 0, {0.3 * frame, root_height, 0.1});
    for (int joint = 1; joint < skeleton.joints(); ++joint) {
      motion.set(frame, joint,
                 motion.position(frame, skeleton.parents[joint]) +
                     factor * skeleton.bone_lengths[joint] * skeleton.rest_directions[joint]);
    }
  }
  return motion;
}

TEST(MotionFinish, BonesGetTheirLengthsAndKeepDirections) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion = stretched_rest(1.3, 1.2);
  impose_bone_lengths(motion, skeleton);
  const Motion expected = stretched_rest(1, 1.2);
  for (size_t i = 0; i < motion.positions.size(); ++i) {
    EXPECT_NEAR(motion.positions[i], expected.positions[i], 1e-5);
  }
}

TEST(MotionFinish, OnlyMotionsBelowTheFloorAreRaised) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion low = stretched_rest(1, 0.5);
  const double raised = lift_to_floor(low, skeleton);
  EXPECT_GT(raised, 0.3);
  double lowest = 1;
  for (const int joint : {7, 8, 10, 11}) lowest = std::min(lowest, low.position(0, joint).y());
  EXPECT_NEAR(lowest, 0, 1e-6);
  EXPECT_NEAR(low.position(1, 0).x(), 0.3, 1e-6);
  Motion high = stretched_rest(1, 2);
  const Motion before = high;
  EXPECT_EQ(lift_to_floor(high, skeleton), 0);
  EXPECT_EQ(high.positions, before.positions);
}

}  // namespace
}  // namespace remomask
