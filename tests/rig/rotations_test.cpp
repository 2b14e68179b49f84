#include "remomask/rotations.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "motion/rotation.h"
#include "motion/vector.h"
#include "remomask/error.h"
#include "rig/forward_kinematics.h"
#include "rig/rest_skeleton.h"
#include "tests/motion/support.h"

namespace remomask {

using rig::joint_positions;
using rig::to_quat;
using rig::to_vec;
using testing_support::largest_difference;
using testing_support::make_walker;
using testing_support::moved;

namespace {

/// Mean and largest distance of joints in millimetres.
struct Misfit {
  double mean = 0, worst = 0, worst_foot = 0;
};

Misfit misfit(const Motion& a, const Motion& b) {
  Misfit result;
  for (int t = 0; t < a.frames; ++t) {
    for (int j = 0; j < a.joints; ++j) {
      const double far = 1000 * (joint_position(a, t, j) - joint_position(b, t, j)).norm();
      result.mean += far / (a.frames * a.joints);
      result.worst = std::max(result.worst, far);
      const bool foot = j == 7 || j == 8 || j == 10 || j == 11;
      if (foot) result.worst_foot = std::max(result.worst_foot, far);
    }
  }
  return result;
}

/// A motion that the rigid skeleton can make exactly.
Motion rigid_walker(int frames, const std::function<double(int)>& heading) {
  return joint_positions(solve_rotations(make_walker(frames, heading)));
}

/// A walker whose chest and pelvis deform: shoulders shrug, the waist bends at the pelvis.
Motion soft_walker(int frames) {
  Motion motion = make_walker(frames);
  for (int t = 0; t < frames; ++t) {
    for (const int j : {13, 16, 18, 20}) motion.at(t, j)[1] += 0.03f * std::sin(0.3f * t);
    for (const int j : {3, 6, 9, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21}) {
      motion.at(t, j)[2] += 0.03f * std::cos(0.2f * t);
    }
  }
  return motion;
}

double degrees_between(const Quat& a, const Quat& b) {
  return a.angularDistance(b) * 180 / std::numbers::pi;
}

/// Largest turn of any joint from one frame to the next.
double largest_step(const JointRotations& pose) {
  double largest = 0;
  for (int t = 1; t < pose.frames; ++t) {
    for (int j = 0; j < pose.joints(); ++j) {
      largest = std::max(
          largest, degrees_between(to_quat(pose.rotation(t - 1, j)), to_quat(pose.rotation(t, j))));
    }
  }
  return largest;
}

/// The walker at a quarter of its speed: at most 7 degrees of thigh swing a frame.
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

/// Puts an arm into the directions `upper` and `lower`.
void pose_left_arm(Motion& motion, int t, const Vec3& upper, const Vec3& lower) {
  const Skeleton& skeleton = humanml_skeleton();
  const Vec3 elbow = joint_position(motion, t, 16) + skeleton.bone_lengths[18] * upper.normalized();
  set_joint_position(motion, t, 18, elbow);
  set_joint_position(motion, t, 20, elbow + skeleton.bone_lengths[20] * lower.normalized());
}

}  // namespace

TEST(Rotations, EveryMotionIsOnTheSameSkeletonThatStandsInATPose) {
  const JointRotations a = solve_rotations(make_walker(20));
  const JointRotations b = solve_rotations(soft_walker(30));
  EXPECT_EQ(a.rest_offsets, b.rest_offsets);
  EXPECT_EQ(a.tips, b.tips);
  Motion rest(1, 22);
  for (int j = 0; j < 22; ++j) {
    const int parent = a.parents[static_cast<size_t>(j)];
    const Vec3 offset = to_vec(a.rest_offsets[static_cast<size_t>(j)]);
    if (j > 0) {
      EXPECT_NEAR(offset.norm(), humanml_skeleton().bone_lengths[static_cast<size_t>(j)], 1e-6);
    }
    set_joint_position(rest, 0, j,
                       parent < 0 ? offset : Vec3(joint_position(rest, 0, parent) + offset));
  }
  EXPECT_NEAR(std::min(rest.at(0, 10)[1], rest.at(0, 11)[1]), 0, 1e-6);
  EXPECT_NEAR(rest.at(0, 15)[1], 1.6, 0.05);
  for (const int j : {18, 20}) EXPECT_NEAR(rest.at(0, j)[1], rest.at(0, 16)[1], 0.01);
  EXPECT_GT(rest.at(0, 20)[0], 0.5);
  EXPECT_LT(rest.at(0, 21)[0], -0.5);
  EXPECT_GT(rest.at(0, 10)[2], rest.at(0, 7)[2] + 0.1);
}

TEST(Rotations, WhatIsRigidComesBackWhateverItsHeading) {
  for (const double heading : {0.0, 1.6, 3.1, 4.7}) {
    const Motion motion = rigid_walker(40, [&](int t) { return heading + 0.03 * t; });
    EXPECT_LT(largest_difference(joint_positions(solve_rotations(motion)), motion), 2e-5);
  }
}

TEST(Rotations, WhatDeformsIsMetByTheNearestRigidPose) {
  const Motion motion = soft_walker(80);
  const Motion rigid = joint_positions(solve_rotations(motion));
  const Misfit far = misfit(motion, rigid);
  EXPECT_LT(far.mean, 12);
  EXPECT_LT(far.worst, 40);
  EXPECT_LT(far.worst_foot, 1);
  // To lay the body out bone by bone from the pelvis instead would push the feet away.
  for (int t = 0; t < motion.frames; ++t) {
    for (int j = 1; j < 22; ++j) {
      const int parent = humanml_skeleton().parents[static_cast<size_t>(j)];
      EXPECT_NEAR((joint_position(rigid, t, j) - joint_position(rigid, t, parent)).norm(),
                  humanml_skeleton().bone_lengths[static_cast<size_t>(j)], 2e-6);
    }
  }
}

TEST(Rotations, FeetThatStandGoOnStanding) {
  Motion motion = testing_support::make_swaying_statue(60);
  for (int t = 0; t < motion.frames; ++t) {
    for (const int j : {3, 6, 9, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21}) {
      motion.at(t, j)[2] += 0.03f * std::cos(0.2f * static_cast<float>(t));
    }
  }
  const Motion rigid = joint_positions(solve_rotations(motion));
  double slide = 0;
  for (int t = 1; t < motion.frames; ++t) {
    slide =
        std::max(slide, (joint_position(rigid, t, 10) - joint_position(rigid, t - 1, 10)).norm());
  }
  EXPECT_LT(slide, 1e-3);
}

TEST(Rotations, NoSuddenTwistsWhateverTheHeading) {
  for (const double heading : {0.0, 1.5, std::numbers::pi, -std::numbers::pi / 2, 4.0}) {
    EXPECT_LT(largest_step(solve_rotations(slow_walker(120, [&](int) { return heading; }))), 6)
        << heading;
  }
  EXPECT_LT(largest_step(solve_rotations(slow_walker(120, [](int t) { return 0.05 * t; }))), 9);
}

TEST(Rotations, AnArmThatPassesBehindItsRestDirectionDoesNotFlip) {
  Motion motion = make_walker(1);
  Motion circle(120, 22);
  for (int t = 0; t < circle.frames; ++t) {
    for (int j = 0; j < 22; ++j) set_joint_position(circle, t, j, joint_position(motion, 0, j));
    // A full circle through the point opposite to the T-pose, the elbow straight, then bending.
    const double angle = 2 * std::numbers::pi * t / 120, bend = 0.004 * t;
    pose_left_arm(circle, t, Vec3(std::cos(angle), 0.05, std::sin(angle)),
                  Vec3(std::cos(angle + bend), 0.05, std::sin(angle + bend)));
  }
  EXPECT_LT(largest_step(solve_rotations(circle)), 12);
}

TEST(Rotations, ABentElbowTurnsAboutItsHinge) {
  Motion motion = make_walker(20);
  for (int t = 0; t < motion.frames; ++t) {
    pose_left_arm(motion, t, Vec3(0.3, -1, 0), Vec3(0.3, 0.2, 1));
  }
  const JointRotations pose = solve_rotations(motion);
  const Vec3 axis = Eigen::AngleAxisd(to_quat(pose.rotation(10, 18))).axis();
  EXPECT_GT(std::abs(axis.y()), 0.97);
}

TEST(Rotations, AKneeThatBendsBackwardsLeavesTheFootOnItsSole) {
  Motion motion = make_walker(1);
  const auto place = [&](int joint, int parent, const Vec3& direction) {
    const double length = humanml_skeleton().bone_lengths[static_cast<size_t>(joint)];
    set_joint_position(motion, 0, joint,
                       joint_position(motion, 0, parent) + length * direction.normalized());
  };
  for (const double bend : {-0.3, -0.1, 0.1, 0.3}) {
    place(4, 1, Vec3(0, -1, bend));
    place(7, 4, Vec3(0, -1, -bend));
    place(10, 7, Vec3(0, -0.4, 1));
    const rig::WorldPose world = rig::world_pose(solve_rotations(motion), 0);
    EXPECT_GT((world.rotations[7] * Vec3::UnitX()).x(), 0.9) << bend;
  }
}

TEST(Rotations, TheTipsOfTheToesStayAboveTheFloor) {
  Motion motion = make_walker(1);
  // The left foot stands on its ball.
  const Vec3 toe = joint_position(motion, 0, 7) +
                   Vec3(0, -0.9, 0.45).normalized() * humanml_skeleton().bone_lengths[10];
  set_joint_position(motion, 0, 10, toe);
  for (int j = 0; j < 22; ++j) motion.at(0, j)[1] -= static_cast<float>(toe.y());
  const JointRotations pose = solve_rotations(motion);
  const rig::WorldPose world = rig::world_pose(pose, 0);
  EXPECT_GT((world.positions[10] + world.rotations[10] * to_vec(pose.tips[10])).y(), -0.005);
}

TEST(Rotations, OtherProportionsTakeTheSkeletonsOrKeepTheirOwn) {
  const Motion tall = moved(make_walker(40), 0, Vec3::Zero(), 1.2);
  const JointRotations common = solve_rotations(tall);
  EXPECT_EQ(common.rest_offsets, solve_rotations(make_walker(2)).rest_offsets);
  EXPECT_NEAR(common.root[39][2] / tall.at(39, 0)[2], 1 / 1.2, 0.03);
  const JointRotations own = solve_rotations(tall, {.own_proportions = true});
  EXPECT_NEAR(to_vec(own.rest_offsets[4]).norm(), 1.2 * humanml_skeleton().bone_lengths[4], 1e-5);
  EXPECT_LT(misfit(joint_positions(own), tall).worst, 1);
}

TEST(Rotations, HeapsOfJointsAreNoReasonToFail) {
  const Motion heap(3, 22);
  const JointRotations own = solve_rotations(heap, {.own_proportions = true});
  for (const Quaternion& q : own.rotations) {
    EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-4);
  }
  EXPECT_THROW(solve_rotations(heap), Error);
  Motion crooked = make_walker(3);
  for (int j = 0; j < 22; ++j) set_joint_position(crooked, 1, j, Vec3(0, 1e-3 * j, 0));
  for (const Vector3& root : solve_rotations(crooked).root) EXPECT_TRUE(to_vec(root).allFinite());
}

TEST(Rotations, RefusesWhatHasNoRotations) {
  EXPECT_THROW(solve_rotations(Motion(0, 22)), Error);
  EXPECT_THROW(solve_rotations(Motion(4, 21)), Error);
  Motion broken = make_walker(3);
  broken.at(1, 5)[2] = NAN;
  EXPECT_THROW(solve_rotations(broken), Error);
}

}  // namespace remomask
