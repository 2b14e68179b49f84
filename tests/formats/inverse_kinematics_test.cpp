#include "formats/inverse_kinematics.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "formats/mapped_kinematics.h"
#include "remomask/error.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::largest_difference;
using testing_support::make_walker;

namespace {

/// Positions that the written BVH text gives, in metres.
Motion through_bvh_text(const Motion& motion) {
  const formats::Bvh bvh =
      formats::parse_bvh(formats::format_bvh(formats::motion_to_bvh(motion)), "own.bvh");
  const rig::SkeletonMap& map =
      *rig::fitting_skeleton_map(rig::shipped_skeleton_maps(), formats::view_of(bvh));
  EXPECT_EQ(map.name, "remomask");
  formats::MappedKinematics kinematics(bvh, map);
  Motion result(bvh.frames, 22);
  for (int t = 0; t < bvh.frames; ++t) kinematics.positions(t, result.at(t, 0));
  for (float& value : result.positions) value /= 100;
  return result;
}

double degrees_between(const Quat& a, const Quat& b) {
  return a.angularDistance(b) * 180 / std::numbers::pi;
}

/// Largest step from frame to frame of any joint's local rotation.
double largest_step(const Motion& motion) {
  const formats::Pose22 pose = formats::solve_pose(motion);
  double largest = 0;
  for (size_t i = 22; i < pose.local.size(); ++i) {
    largest = std::max(largest, degrees_between(pose.local[i - 22], pose.local[i]));
  }
  return largest;
}

/// Walks slowly: 0.25 rad of gait phase a frame is 7 degrees of thigh swing at
/// most; a quarter of the frames' speed by blending.
Motion slow_walker(int frames, const std::function<double(int)>& heading) {
  const Motion coarse = make_walker(frames / 4 + 2, [&](int t) { return heading(4 * t); });
  Motion fine(frames, 22);
  for (int t = 0; t < frames; ++t) {
    const double weight = t % 4 / 4.0;
    for (int j = 0; j < 22; ++j) {
      set_joint_position(fine, t, j,
                         (1 - weight) * joint_position(coarse, t / 4, j) +
                             weight * joint_position(coarse, t / 4 + 1, j));
    }
  }
  return fine;
}

}  // namespace

TEST(InverseKinematics, RigidClipsComeBackFromRotationsAlone) {
  const Motion motion = make_walker(60, [](int t) { return 0.03 * t; });
  EXPECT_LT(largest_difference(through_bvh_text(motion), motion), 1e-4);
}

TEST(InverseKinematics, NonRigidClipsComeBackWithTranslations) {
  Motion motion = make_walker(60);
  for (int t = 0; t < motion.frames; ++t) {  // shoulders that shrug, a waist that bends
    for (const int j : {13, 16, 18, 20}) motion.at(t, j)[1] += 0.03f * std::sin(0.3f * t);
    for (const int j : {3, 6, 9, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21}) {
      motion.at(t, j)[2] += 0.04f * std::cos(0.2f * t);
    }
  }
  EXPECT_FALSE(formats::solve_pose(motion).rigid);
  EXPECT_TRUE(formats::solve_pose(make_walker(60)).rigid);
  EXPECT_LT(largest_difference(through_bvh_text(motion), motion), 1e-3);
}

TEST(InverseKinematics, NoSuddenTwistsWhateverTheHeading) {
  for (const double heading : {0.0, 1.5, std::numbers::pi, -std::numbers::pi / 2, 4.0}) {
    EXPECT_LT(largest_step(slow_walker(200, [&](int) { return heading; })), 5) << heading;
  }
  EXPECT_LT(largest_step(slow_walker(200, [](int t) { return 0.05 * t; })), 8);
}

TEST(InverseKinematics, RestPoseIsATPose) {
  const std::vector<Vec3> rest = formats::solve_pose(make_walker(30)).rest_offsets;
  for (const int j : {18, 20}) EXPECT_GT(rest[j].normalized().x(), 0.99);
  for (const int j : {19, 21}) EXPECT_LT(rest[j].normalized().x(), -0.99);
  for (const int j : {4, 5, 7, 8}) EXPECT_LT(rest[j].normalized().y(), -0.98);
  EXPECT_GT(rest[1].x(), 0.03);
  EXPECT_GT(rest[3].y(), 0.1);
}

TEST(InverseKinematics, BvhFollowsTheConventions) {
  const formats::Bvh bvh = formats::motion_to_bvh(make_walker(90, [](int t) { return 0.1 * t; }));
  ASSERT_EQ(bvh.joints.size(), 22u);
  EXPECT_EQ(bvh.joints[0].name, "Hips");
  EXPECT_EQ(bvh.joints[0].offset, Vec3(0, 0, 0));
  EXPECT_EQ(bvh.joints[0].channels, (std::vector<formats::BvhChannel>{0, 1, 2, 5, 4, 3}));
  EXPECT_EQ(bvh.joints[1].channels, (std::vector<formats::BvhChannel>{5, 4, 3}));
  EXPECT_NEAR(bvh.values[1], 93, 1e-3);
  EXPECT_DOUBLE_EQ(bvh.frame_time, 0.05);
  int ends = 0;
  for (const formats::BvhJoint& joint : bvh.joints) ends += joint.end_site.has_value();
  EXPECT_EQ(ends, 5);
  // Angles run on beyond 180 degrees instead of jumping.
  for (int t = 1; t < bvh.frames; ++t) {
    for (int c = 3; c < bvh.channels; ++c) {
      const size_t at = static_cast<size_t>(t) * bvh.channels + c;
      EXPECT_LT(std::abs(bvh.values[at] - bvh.values[at - bvh.channels]), 60) << t << " " << c;
    }
  }
  EXPECT_THROW(formats::motion_to_bvh(Motion(0, 22)), Error);
  EXPECT_THROW(formats::motion_to_bvh(Motion(4, 21)), Error);
}

}  // namespace remomask
