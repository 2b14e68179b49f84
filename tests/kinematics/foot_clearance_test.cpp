#include "kinematics/foot_clearance.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinematics/leg.h"
#include "synthetic/procedural.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::largest_difference;

namespace {

constexpr int kFrames = 60;
constexpr int kStep = 10;       // frames that a foot stands or swings
constexpr double kSpeed = 1.5;  // m/s of the body

/// A body that moves over the floor with bent knees: its feet take turns in standing
/// and in swinging, twice as fast as the body, at height `swing` of the toe.
Motion stepping(double swing) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion(kFrames, skeleton.joints());
  for (int t = 0; t < kFrames; ++t) {
    for (int joint = 0; joint < motion.joints; ++joint) {
      Vec3 place(0, 0.8, t * kSpeed / skeleton.fps);
      for (int j = joint; skeleton.parents[static_cast<size_t>(j)] >= 0;
           j = skeleton.parents[static_cast<size_t>(j)]) {
        place += skeleton.bone_lengths[static_cast<size_t>(j)] *
                 rest_direction(skeleton, static_cast<size_t>(j));
      }
      set_joint_position(motion, t, joint, place);
    }
    int foot = 0;
    for (const auto* feet : {&skeleton.left_feet, &skeleton.right_feet}) {
      kinematics::Leg leg = kinematics::leg_of(*feet, skeleton, motion, t);
      leg.upper = skeleton.bone_lengths[static_cast<size_t>(leg.knee)];
      leg.lower = skeleton.bone_lengths[static_cast<size_t>(leg.ankle)];
      motion.at(t, leg.knee)[2] += 0.05f;  // bend forward
      const int turn = (t + foot++ * kStep) % (2 * kStep);
      const bool stands = turn < kStep;
      const double along = stands ? -(turn - 0.5 * kStep) : turn - 1.5 * kStep;
      Vec3 shift(0, 0, along * kSpeed / skeleton.fps);
      shift.y() = (stands ? 0.0 : swing) - joint_position(motion, t, leg.toe).y();
      kinematics::move_foot(motion, t, leg, shift);
    }
  }
  return motion;
}

/// Heights of the left toe in the middles of its swings.
std::vector<double> swing_heights(const Motion& motion) {
  std::vector<double> heights;
  for (int t = kStep + kStep / 2; t < kFrames; t += 2 * kStep) {
    heights.push_back(joint_position(motion, t, humanml_skeleton().left_feet.back()).y());
  }
  return heights;
}

TEST(FootClearance, SwingsThatBrushTheFloorReachTheHeightOfTheirSpeed) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion before = stepping(0.01);
  Motion after = before;
  kinematics::raise_swings(after, skeleton);
  for (const double height : swing_heights(after)) {
    EXPECT_NEAR(height, kinematics::FootClearanceOptions{}.height * kSpeed, 1e-3);
  }
  for (int t = 0; t < kFrames; ++t) {
    for (int joint = 1; joint < after.joints; ++joint) {
      const auto bone = [&](const Motion& motion) {
        return (joint_position(motion, t, joint) -
                joint_position(motion, t, skeleton.parents[static_cast<size_t>(joint)]))
            .norm();
      };
      EXPECT_NEAR(bone(after), bone(before), 1e-5) << t << " " << joint;
    }
    // Standing feet, and all that is no leg, stay bit for bit.
    const int turn = t % (2 * kStep);
    for (int joint = 0; joint < after.joints; ++joint) {
      const bool is_left_leg = joint == 4 || joint == 7 || joint == 10;
      const bool is_right_leg = joint == 5 || joint == 8 || joint == 11;
      const bool stays = (!is_left_leg || (turn > 0 && turn < kStep - 1)) &&
                         (!is_right_leg || (turn > kStep && turn < 2 * kStep - 1));
      if (!stays) continue;
      EXPECT_EQ(joint_position(after, t, joint), joint_position(before, t, joint))
          << t << " " << joint;
    }
  }
}

TEST(FootClearance, HighSwingsAndStandingBodiesStayBitForBit) {
  for (const Motion& before : {stepping(0.08), synthetic::make_procedural_clip("stand").motion}) {
    Motion after = before;
    kinematics::raise_swings(after, humanml_skeleton());
    EXPECT_EQ(after.positions, before.positions);
  }
}

TEST(FootClearance, NoFootIsRaisedByMoreThanAllowed) {
  kinematics::FootClearanceOptions options;
  options.height = 1;
  options.max_raise = 0.03;
  const Motion before = stepping(0.01);
  Motion after = before;
  kinematics::raise_swings(after, humanml_skeleton(), options);
  for (const double height : swing_heights(after)) EXPECT_NEAR(height, 0.04, 1e-4);
}

}  // namespace
}  // namespace remomask
