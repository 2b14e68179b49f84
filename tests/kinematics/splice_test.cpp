#include "kinematics/splice.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinematics/foot_lock.h"
#include "kinematics/pose_fit.h"
#include "motion/canonical.h"
#include "motion/rotation.h"
#include "remomask/error.h"
#include "synthetic/procedural.h"
#include "tests/motion/support.h"

namespace remomask {
namespace {

using testing_support::largest_difference;
using testing_support::moved;

constexpr int kLeftArm = 4, kRightArm = 5;

Motion walk(const std::string& kind, int frames, uint64_t variation = 3) {
  synthetic::ProceduralParameters parameters;
  parameters.duration = 8;
  parameters.variation = variation;
  const Motion motion = synthetic::make_procedural_clip(kind, parameters).motion;
  return slice(motion, 20, 20 + frames);
}

/// A canonical motion, as a decoder makes them, and the same anywhere.
const Motion& original() {
  static const Motion motion = moved(walk("walk-forward", 100), 0.7, Vec3(3, 0.4, -2), 1.1);
  return motion;
}

void expect_kept(const Motion& result, const Motion& before, const motion::PartMask& mask) {
  const std::vector<int> parts = motion::joint_parts(humanml_skeleton());
  for (int t = 0; t < before.frames; ++t) {
    for (int j = 0; j < 22; ++j) {
      if (mask.has(t, parts[static_cast<size_t>(j)])) continue;
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_EQ(result.at(t, j)[axis], before.at(t, j)[axis]) << t << " " << j;
      }
    }
  }
}

void expect_bones(const Motion& result, const Motion& before) {
  const Skeleton& skeleton = humanml_skeleton();
  const std::vector<double> lengths = kinematics::mean_bone_lengths(before, skeleton);
  for (int t = 0; t < result.frames; ++t) {
    for (int j = 1; j < 22; ++j) {
      const double length = (joint_position(result, t, j) -
                             joint_position(result, t, skeleton.parents[static_cast<size_t>(j)]))
                                .norm();
      ASSERT_NEAR(length, lengths[static_cast<size_t>(j)], 2e-5) << t << " " << j;
    }
  }
}

/// Largest step of any joint between two frames around the edges of a span, m.
double largest_step(const Motion& motion, int first, int last) {
  double largest = 0;
  for (int t = std::max(0, first - 2); t + 1 < std::min(motion.frames, last + 2); ++t) {
    for (int j = 0; j < 22; ++j) {
      largest = std::max(largest,
                         (joint_position(motion, t + 1, j) - joint_position(motion, t, j)).norm());
    }
  }
  return largest;
}

std::vector<motion::PartMask> masks() {
  std::vector<motion::PartMask> result(7, motion::PartMask(100));
  result[0].add(40, 70);               // in between
  result[1].add(0, 33);                // the beginning
  result[2].add(61, 100);              // the end
  result[3].add(0, 100, {kLeftArm});   // one arm throughout
  result[4].add(20, 50, {2, 3});       // the spine, between fixed limbs
  result[5].add(20, 50, {0, 1, 2});    // the lower body
  result[6].add(10, 30, {kRightArm});  // any set
  result[6].add(25, 60);
  result[6].add(55, 80, {0, kLeftArm});
  return result;
}

TEST(SpliceMotion, TheSameMotionFitsItself) {
  // What was made shows the same, elsewhere and of another size.
  const Motion made = walk("walk-forward", 100);
  for (const motion::PartMask& mask : masks()) {
    kinematics::SpliceReport report;
    const Motion result =
        kinematics::splice_motion(original(), made, mask, humanml_skeleton(), {}, &report);
    expect_kept(result, original(), mask);
    expect_bones(result, original());
    // Standing feet are held still, which the walk's rolling toes are not quite.
    EXPECT_LT(largest_difference(result, original()), 0.035);
    EXPECT_LT(report.path_shift, 1e-3);
    EXPECT_LT(report.path_turn, 1e-3);
  }
}

TEST(SpliceMotion, AnotherMotionIsBentToMeetWhatStays) {
  const Motion made = walk("walk-circle-left", 100, 5);
  const double usual = std::max(largest_step(original(), 0, 100), largest_step(made, 0, 100));
  int number = 0;
  for (const motion::PartMask& mask : masks()) {
    const Motion result = kinematics::splice_motion(original(), made, mask, humanml_skeleton());
    expect_kept(result, original(), mask);
    expect_bones(result, original());
    EXPECT_LT(largest_step(result, 0, 100), 2 * usual) << number;
    EXPECT_GT(largest_difference(result, original()), 0.01) << number;
    ++number;
  }
}

TEST(SpliceMotion, ReportsHowFarThePathWasBent) {
  const Motion made = walk("walk-circle-left", 100, 5);
  kinematics::SpliceReport report;
  kinematics::splice_motion(original(), made, masks()[0], humanml_skeleton(), {}, &report);
  EXPECT_GT(report.path_turn, 0.2);
  kinematics::splice_motion(original(), made, masks()[2], humanml_skeleton(), {}, &report);
  EXPECT_EQ(report.path_turn, 0);
  EXPECT_EQ(report.path_shift, 0);
}

TEST(SpliceMotion, ContinuesPastTheEnd) {
  const Motion start = slice(original(), 0, 60);
  motion::PartMask mask(100);
  mask.add(60, 100);
  const Motion result =
      kinematics::splice_motion(start, walk("walk-forward", 100), mask, humanml_skeleton());
  ASSERT_EQ(result.frames, 100);
  expect_kept(result, start, mask);
  // The walk that was cut off goes on as it did.
  EXPECT_LT(largest_difference(result, original()), 0.035);
}

TEST(SpliceMotion, SizesThatDoNotFitAreErrors) {
  const Motion made = walk("walk-forward", 100);
  motion::PartMask mask(100);
  mask.add(60, 90);
  EXPECT_THROW(kinematics::splice_motion(slice(original(), 0, 50), made, mask, humanml_skeleton()),
               Error);
  EXPECT_THROW(kinematics::splice_motion(original(), slice(made, 0, 90), mask, humanml_skeleton()),
               Error);
  EXPECT_THROW(mask.add(90, 101), Error);
  EXPECT_THROW(mask.add(9, 9), Error);
  EXPECT_THROW(mask.add(0, 9, {6}), Error);
}

TEST(LockFeet, AStandingFootThatSlidesIsHeld) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion guide = walk("walk-forward", 80);
  // The whole body drifts sideways by half a metre a second and sinks 2 cm.
  Motion sliding = guide;
  for (int t = 0; t < 80; ++t) {
    for (int j = 0; j < 22; ++j) {
      sliding.at(t, j)[0] += 0.025f * static_cast<float>(t);
      sliding.at(t, j)[1] -= 0.02f;
    }
  }
  const auto slide = [&](const Motion& motion) {
    double sum = 0;
    int count = 0;
    for (int t = 0; t + 1 < 80; ++t) {
      for (const int toe : {10, 11}) {
        const Vec3 step = joint_position(guide, t + 1, toe) - joint_position(guide, t, toe);
        if (guide.at(t, toe)[1] > 0.05f || std::hypot(step.x(), step.z()) > 0.01) continue;
        const Vec3 moved_by = joint_position(motion, t + 1, toe) - joint_position(motion, t, toe);
        sum += std::hypot(moved_by.x(), moved_by.z());
        ++count;
      }
    }
    return 20 * sum / count;
  };
  motion::PartMask mask(80);
  mask.add(0, 80);
  Motion held = sliding;
  kinematics::lock_feet(held, guide, 0, mask, skeleton);
  EXPECT_GT(slide(sliding), 0.45);
  EXPECT_LT(slide(held), 0.1);
  for (int t = 0; t < 80; ++t) {
    for (const int joint : {7, 8, 10, 11}) EXPECT_GT(held.at(t, joint)[1], -1e-3f);
    for (const int joint : {0, 1, 2, 9, 15, 20}) {
      EXPECT_EQ(joint_position(held, t, joint), joint_position(sliding, t, joint));
    }
  }
  expect_bones(held, guide);
}

}  // namespace
}  // namespace remomask
