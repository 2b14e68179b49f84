#include "motion/canonical.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "motion/heading.h"
#include "remomask/error.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::largest_difference;
using testing_support::make_walker;
using testing_support::moved;

TEST(Canonical, FloorOriginAndFacing) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion motion =
      motion::canonicalize(moved(make_walker(50), 2.2, {5, 3, 1}, 0.01), skeleton);
  float lowest = 1e9f;
  for (size_t i = 1; i < motion.positions.size(); i += 3) {
    lowest = std::min(lowest, motion.positions[i]);
  }
  EXPECT_NEAR(lowest, 0, 1e-6);
  EXPECT_NEAR(joint_position(motion, 0, 0).x(), 0, 1e-6);
  EXPECT_NEAR(joint_position(motion, 0, 0).z(), 0, 1e-6);
  const Vec3 forward = Vec3::UnitY().cross(motion::across_body(motion, 0, skeleton));
  EXPECT_NEAR(std::atan2(forward.x(), forward.z()), 0, 1e-5);
  EXPECT_GT(joint_position(motion, 49, 0).z(), 2);  // it walks to the front
}

TEST(Canonical, BonesTakeTheUniformLengthsAndKeepTheirDirections) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion raw = make_walker(10);
  for (int t = 0; t < 10; ++t) {  // a longer left arm
    set_joint_position(
        raw, t, 20,
        joint_position(raw, t, 18) + 2 * (joint_position(raw, t, 20) - joint_position(raw, t, 18)));
  }
  const motion::CanonicalOptions lengths_only{true, false, false, false};
  const Motion motion = motion::canonicalize(raw, skeleton, lengths_only);
  EXPECT_LT(largest_difference(motion, make_walker(10)), 2e-6);
}

TEST(Canonical, IsIdempotent) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion once = motion::canonicalize(moved(make_walker(50), 1, {1, 2, 3}), skeleton);
  EXPECT_LT(largest_difference(once, motion::canonicalize(once, skeleton)), 2e-6);
}

TEST(Canonical, RefusesBrokenInput) {
  const Skeleton& skeleton = humanml_skeleton();
  Motion infinite = make_walker(3);
  infinite.at(1, 2)[0] = std::numeric_limits<float>::infinity();
  EXPECT_THROW(motion::canonicalize(infinite, skeleton), Error);
  EXPECT_THROW(motion::canonicalize(Motion(3, 22), skeleton), Error);  // legs without length
  EXPECT_THROW(motion::canonicalize(Motion(0, 22), skeleton), Error);
  EXPECT_THROW(motion::canonicalize(Motion(3, 21), skeleton), Error);
}

TEST(Canonical, MirrorTwiceIsTheIdentity) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion motion = make_walker(20, [](int t) { return 0.1 * t; });
  const Motion mirrored = motion::mirror_motion(motion, skeleton);
  EXPECT_EQ(motion::mirror_motion(mirrored, skeleton).positions, motion.positions);
  EXPECT_FLOAT_EQ(mirrored.at(7, 20)[0], -motion.at(7, 21)[0]);
  EXPECT_FLOAT_EQ(mirrored.at(7, 20)[1], motion.at(7, 21)[1]);
}

TEST(Resample, InterpolatesInTime) {
  Motion motion(31, 1);  // one second at 30 frames a second
  for (int t = 0; t < 31; ++t) set_joint_position(motion, t, 0, Vec3(t, 0, t * t));
  const Motion slow = motion::resample(motion, 30, 20);
  ASSERT_EQ(slow.frames, 21);
  for (int t = 0; t < 21; ++t) EXPECT_NEAR(joint_position(slow, t, 0).x(), 1.5 * t, 1e-5);
  EXPECT_NEAR(joint_position(slow, 1, 0).z(), 2.5, 1e-5);  // between 1 and 4
  EXPECT_EQ(motion::resample(motion, 59.999, 59.999).frames, 31);
  EXPECT_EQ(motion::resample(slice(motion, 0, 1), 30, 20).frames, 1);
  EXPECT_THROW(motion::resample(motion, 0, 20), Error);
}

TEST(Slice, TakesFramesAndRefusesOthers) {
  const Motion motion = make_walker(10);
  EXPECT_EQ(slice(motion, 3, 7).frames, 4);
  EXPECT_EQ(joint_position(slice(motion, 3, 7), 0, 5), joint_position(motion, 3, 5));
  EXPECT_THROW(slice(motion, 3, 11), Error);
  EXPECT_THROW(slice(motion, -1, 2), Error);
}

}  // namespace remomask
