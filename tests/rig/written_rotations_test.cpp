#include "rig/written_rotations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "motion/rotation.h"
#include "remomask/error.h"
#include "rig/forward_kinematics.h"
#include "rig/joint_names.h"
#include "rig/resample_rotations.h"
#include "rig/root_motion.h"
#include "tests/motion/support.h"

namespace remomask {

using rig::joint_positions;
using rig::to_quat;
using rig::to_vec;
using testing_support::largest_difference;
using testing_support::make_statue;
using testing_support::make_walker;

namespace {

double heading(const Quat& rotation) {
  const Vec3 forward = rotation * Vec3::UnitZ();
  return std::atan2(forward.x(), forward.z());
}

}  // namespace

TEST(WrittenRotations, OnlyTheRootMovesAndItLiesOnTheGround) {
  const Motion motion = make_walker(40, [](int t) { return 0.04 * t; });
  const JointRotations solved = solve_rotations(motion, {.keep_rigid = true});
  const JointRotations written = rig::rotations_to_write(motion, {}).motion;
  ASSERT_EQ(written.joints(), 23);
  EXPECT_EQ(written.joint_names[0], "Root");
  EXPECT_EQ(written.joint_names[1], "Hips");
  EXPECT_EQ(written.parents[1], 0);
  EXPECT_EQ(written.rest_offsets[0], (Vector3{0, 0, 0}));
  EXPECT_EQ(written.rest_offsets[1], solved.rest_offsets[0]);
  EXPECT_LT(largest_difference(joint_positions(written), joint_positions(solved)), 1e-5);
  for (int t = 0; t < written.frames; ++t) {
    EXPECT_EQ(written.rotation(t, 0), (Quaternion{0, 0, 0, 1}));
    EXPECT_LT(std::abs(written.root[static_cast<size_t>(t)][1]), 0.1);
  }
}

TEST(WrittenRotations, RootMotionCarriesTheHeading) {
  const Motion motion = make_walker(90, [](int t) { return 0.1 * t; });
  const JointRotations plain = rig::rotations_to_write(motion, {}).motion;
  const JointRotations written = rig::rotations_to_write(motion, {.root_motion = true}).motion;
  EXPECT_LT(largest_difference(joint_positions(written), joint_positions(plain)), 1e-5);
  for (int t = 0; t < written.frames; ++t) {
    const Quat root = to_quat(written.rotation(t, 0));
    EXPECT_NEAR(root.x(), 0, 1e-6);
    EXPECT_NEAR(root.z(), 0, 1e-6);
    EXPECT_NEAR(std::remainder(heading(root) - 0.1 * t, 2 * std::numbers::pi), 0, 0.15) << t;
    EXPECT_LT(std::abs(heading(to_quat(written.rotation(t, 1)))), 0.1) << t;
  }
}

TEST(WrittenRotations, ASomersaultHasAHeadingWithoutJumps) {
  Motion motion = make_statue(60, [](int) { return 0.3; });
  for (int t = 0; t < motion.frames; ++t) {
    const Quat turn = motion::yaw_rotation(0.3) *
                      Quat(Eigen::AngleAxisd(2 * std::numbers::pi * t / 60, Vec3::UnitX())) *
                      motion::yaw_rotation(-0.3);
    const Vec3 centre(0, 1, 0);
    for (int j = 0; j < 22; ++j) {
      set_joint_position(motion, t, j, centre + turn * (joint_position(motion, t, j) - centre));
    }
  }
  const JointRotations written = rig::rotations_to_write(motion, {.root_motion = true}).motion;
  for (int t = 1; t < written.frames; ++t) {
    EXPECT_LT(to_quat(written.rotation(t, 0)).angularDistance(to_quat(written.rotation(t - 1, 0))),
              0.25)
        << t;
  }
}

TEST(WrittenRotations, InPlaceKeepsHeightsAndPoses) {
  const Motion motion = make_walker(40);
  const JointRotations plain = rig::rotations_to_write(motion, {}).motion;
  const JointRotations written = rig::rotations_to_write(motion, {.in_place = true}).motion;
  EXPECT_EQ(written.rotations, plain.rotations);
  for (size_t t = 0; t < 40; ++t) {
    EXPECT_EQ(written.root[t], (Vector3{0, plain.root[t][1], 0}));
  }
}

TEST(WrittenRotations, ALoopEndsAsItBegins) {
  // Twenty-five frames are a cycle of the walker and do not end it exactly.
  const Motion walk = make_walker(27);
  rig::RotationsToWrite written = rig::rotations_to_write(walk, {.loop = true});
  ASSERT_TRUE(written.written.loop.has_value());
  EXPECT_TRUE(written.written.loop->travels);
  EXPECT_GT(written.written.loop->degrees, 1);
  const JointRotations& loop = written.motion;
  for (int j = 0; j < loop.joints(); ++j) {
    EXPECT_LT(to_quat(loop.rotation(0, j)).angularDistance(to_quat(loop.rotation(26, j))), 3e-3);
  }
  EXPECT_NEAR(loop.root[0][1], loop.root[26][1], 1e-5);
  EXPECT_GT(loop.root[26][2], 1);  // goes on walking
  const JointRotations plain = rig::rotations_to_write(walk, {}).motion;
  for (int j = 0; j < loop.joints(); ++j) EXPECT_EQ(loop.rotation(10, j), plain.rotation(10, j));

  Motion wave = make_statue(40, [](int t) { return 0.005 * t; });
  const auto stays = rig::rotations_to_write(wave, {.loop = true});
  EXPECT_FALSE(stays.written.loop->travels);
  EXPECT_LT(
      to_quat(stays.motion.rotation(0, 1)).angularDistance(to_quat(stays.motion.rotation(39, 1))),
      3e-3);
}

TEST(WrittenRotations, StandingFeetDoNotSlideAtTheSeamOfALoop) {
  const Motion walk = make_walker(47);
  const Motion sway = testing_support::make_swaying_statue(40);
  for (const Motion* source : {&walk, &sway}) {
    const Motion plain = joint_positions(rig::rotations_to_write(*source, {}).motion);
    const rig::RotationsToWrite written = rig::rotations_to_write(*source, {.loop = true});
    const Motion loop = joint_positions(written.motion);
    const auto slide = [](const Motion& motion, int frame, int toe) {
      Vec3 way = joint_position(motion, frame, toe) - joint_position(motion, frame - 1, toe);
      way.y() = 0;
      return way.norm();
    };
    // Feet that stood before the loop was closed, and were not lifted for a step.
    double sum = 0;
    int count = 0;
    for (const int toe : {10, 11}) {
      for (int t = loop.frames - 20; t < loop.frames; ++t) {
        if (slide(plain, t, toe) >= 0.002 || joint_position(loop, t, toe).y() > 0.02) continue;
        sum += slide(loop, t, toe);
        ++count;
      }
    }
    // The walker made by formula never stands on a foot for long.
    if (source == &sway) {
      ASSERT_GT(count, 5);
      EXPECT_LT(sum / count, 0.003) << "6 cm a second";
    }
    // The step over the seam, from the last frame to the second of the next cycle, is that from
    // the first frame to the second one.
    const Quat turn =
        motion::yaw_rotation(written.written.loop->travels
                                 ? heading(to_quat(written.motion.rotation(loop.frames - 1, 1))) -
                                       heading(to_quat(written.motion.rotation(0, 1)))
                                 : 0);
    for (const int toe : {10, 11}) {
      const Vec3 first = joint_position(loop, 0, toe) - joint_position(loop, 0, 0);
      const Vec3 last =
          joint_position(loop, loop.frames - 1, toe) - joint_position(loop, loop.frames - 1, 0);
      EXPECT_LT((turn * first - last).norm(), 2e-3) << toe;
    }
  }
}

TEST(WrittenRotations, OtherFrameRatesKeepTheMotion) {
  const Motion motion = make_walker(41, [](int t) { return 0.02 * t; });
  const JointRotations solved = solve_rotations(motion);
  for (const double fps : {24.0, 25.0, 30.0, 50.0, 60.0, 120.0}) {
    const JointRotations other = rig::resample_rotations(solved, fps);
    EXPECT_EQ(other.frames, static_cast<int>(2 * fps) + 1);
    EXPECT_EQ(other.fps, fps);
    EXPECT_EQ(other.rotation(0, 4), solved.rotation(0, 4));
    // Where both have a frame, they are the same.
    const Motion now = joint_positions(other), before = joint_positions(solved);
    for (int s = 0; s <= 2; ++s) {
      for (int j = 0; j < 22; ++j) {
        EXPECT_LT(
            (joint_position(now, static_cast<int>(s * fps), j) - joint_position(before, 20 * s, j))
                .norm(),
            1e-5);
      }
    }
  }
  const JointRotations back = rig::resample_rotations(rig::resample_rotations(solved, 60), 20);
  EXPECT_LT(largest_difference(joint_positions(back), joint_positions(solved)), 1e-5);
  EXPECT_THROW(rig::resample_rotations(solved, 0), Error);
  EXPECT_THROW(rig::resample_rotations(solved, 241), Error);
  EXPECT_THROW(rig::resample_rotations(solved, NAN), Error);
}

TEST(WrittenRotations, AStandingFootStandsAtOtherFrameRates) {
  const Motion motion = testing_support::make_swaying_statue(20);
  const JointRotations solved = solve_rotations(motion);
  const Motion source = joint_positions(solved);
  const Motion fast = joint_positions(rig::resample_rotations(solved, 120));
  const Vec3 place = joint_position(source, 0, 10);
  double before = 0, after = 0;
  for (int t = 0; t < source.frames; ++t) {
    before = std::max(before, (joint_position(source, t, 10) - place).norm());
  }
  for (int t = 0; t < fast.frames; ++t) {
    after = std::max(after, (joint_position(fast, t, 10) - place).norm());
  }
  EXPECT_LT(after, before + 5e-4);
}

TEST(JointNames, PresetsAreComplete) {
  EXPECT_EQ(rig::name_presets().size(), 6u);
  for (const rig::NamePreset& preset : rig::name_presets()) {
    std::set<std::string> names(preset.joints.begin(), preset.joints.end());
    names.emplace(preset.root);
    EXPECT_EQ(names.size(), 23u) << preset.option;
    const std::vector<std::string> list(names.begin(), names.end());
    const rig::NamePreset* found = rig::find_name_preset(list);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->joints, preset.joints);
    names.erase(std::string(preset.joints[10]));
    EXPECT_EQ(rig::find_name_preset({names.begin(), names.end()}), nullptr);
  }
  EXPECT_EQ(rig::name_preset(JointNames::unreal).joints[7], "foot_l");
  EXPECT_EQ(rig::name_preset(JointNames::mixamo).joints[10], "LeftToeBase");
}

}  // namespace remomask
