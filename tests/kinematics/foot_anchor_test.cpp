#include "kinematics/foot_anchor.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "remomask/error.h"
#include "tests/motion/support.h"

namespace remomask {
namespace {

/// A body in its rest shape that glides by `step` each frame.
Motion gliding(int frames, const Vec3& step) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion(frames, skeleton.joints());
  for (int t = 0; t < frames; ++t) {
    for (int joint = 0; joint < motion.joints; ++joint) {
      Vec3 place = t * step + Vec3(0, 0.9, 0);
      for (int j = joint; skeleton.parents[static_cast<size_t>(j)] >= 0;
           j = skeleton.parents[static_cast<size_t>(j)]) {
        place += skeleton.bone_lengths[static_cast<size_t>(j)] *
                 rest_direction(skeleton, static_cast<size_t>(j));
      }
      set_joint_position(motion, t, joint, place);
    }
  }
  return motion;
}

kinematics::FootContacts always(int frames, bool left, bool right) {
  return kinematics::FootContacts(static_cast<size_t>(frames), {left, right});
}

TEST(FootAnchor, ABodyThatGlidesOnItsFeetStands) {
  const Motion glide = gliding(10, {0.03, 0, 0.04});
  Motion anchored = glide;
  kinematics::anchor_to_feet(anchored, always(10, true, false), humanml_skeleton(), /*fastest=*/2);
  EXPECT_LT(largest_difference(anchored, gliding(10, Vec3::Zero())), 1e-5);
  // At three quarters of the limit half of it is taken out.
  Motion slowed = glide;
  kinematics::anchor_to_feet(slowed, always(10, true, true), humanml_skeleton(),
                             /*fastest=*/4. / 3);
  EXPECT_LT(largest_difference(slowed, gliding(10, {0.015, 0, 0.02})), 1e-5);
  // Without contact, or as fast as a body on its way (1 m/s is 5 cm a frame), it goes on.
  Motion flying = glide;
  kinematics::anchor_to_feet(flying, always(10, false, false), humanml_skeleton());
  EXPECT_EQ(flying.positions, glide.positions);
  Motion fast = glide;
  kinematics::anchor_to_feet(fast, always(10, true, true), humanml_skeleton(), /*fastest=*/0.99);
  EXPECT_EQ(fast.positions, glide.positions);
}

TEST(FootAnchor, HeightsAndPosesStayAndTheMeanOfTwoFeetCounts) {
  Motion motion = gliding(12, {0, 0.01, 0});
  const Skeleton& skeleton = humanml_skeleton();
  for (int t = 0; t < 12; ++t) {  // the left foot slides outward, the right one stands
    for (const int joint : skeleton.left_feet) motion.at(t, joint)[0] += 0.02f * t;
  }
  Motion anchored = motion;
  kinematics::anchor_to_feet(anchored, always(12, true, true), skeleton);
  for (int t = 0; t < 12; ++t) {
    for (int joint = 0; joint < motion.joints; ++joint) {
      const Vec3 moved = joint_position(anchored, t, joint) - joint_position(motion, t, joint);
      EXPECT_NEAR(moved.x(), -0.01 * t, 1e-5);
      EXPECT_EQ(moved.y(), 0);
      EXPECT_NEAR(moved.z(), 0, 1e-6);
    }
  }
  EXPECT_THROW(kinematics::anchor_to_feet(anchored, always(11, true, true), skeleton), Error);
}

TEST(FootAnchor, ContactsAreReadFromTheToesAndCleaned) {
  const Skeleton& skeleton = humanml_skeleton();
  motion::Features features(8, skeleton.feature_dim());
  const auto mark = [&](int column, const std::vector<int>& frames) {
    for (const int t : frames) features.row(t)[column] = 0.9f;
  };
  mark(260, {0, 1, 2, 4, 5});  // left toe, a gap of one frame
  mark(261, {0, 1, 2, 3});     // right ankle: not asked
  mark(262, {3, 4});           // right toe, too short
  const kinematics::FootContacts contacts = kinematics::read_contacts(features, skeleton);
  const std::vector<bool> left = {true, true, true, true, true, true, false, false};
  for (size_t t = 0; t < 8; ++t) {
    EXPECT_EQ(contacts[t][0], left[t]) << t;
    EXPECT_FALSE(contacts[t][1]) << t;
  }
  EXPECT_THROW(kinematics::read_contacts(motion::Features(3, 10), skeleton), Error);
}

}  // namespace
}  // namespace remomask
