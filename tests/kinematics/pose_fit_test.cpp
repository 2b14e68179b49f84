#include "kinematics/pose_fit.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include "tests/motion/support.h"

namespace remomask {
namespace {

std::vector<Vec3> pose_of(const Motion& motion, int frame) {
  std::vector<Vec3> pose;
  for (int j = 0; j < motion.joints; ++j) pose.push_back(joint_position(motion, frame, j));
  return pose;
}

double worst_bone(const std::vector<Vec3>& pose, const std::vector<double>& lengths) {
  const Skeleton& skeleton = humanml_skeleton();
  double worst = 0;
  for (int j = 1; j < skeleton.joints(); ++j) {
    worst = std::max(worst, std::abs((pose[j] - pose[skeleton.parents[j]]).norm() - lengths[j]));
  }
  return worst;
}

TEST(FitFreeJoints, AHangingChainTakesTheDirectionsOfItsTarget) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion walk = testing_support::make_walker(20);
  std::vector<Vec3> pose = pose_of(walk, 3);
  std::vector<Vec3> target = pose_of(walk, 12);
  for (Vec3& joint : target) joint = 2 * joint + Vec3(1, 2, 3);  // another size and place
  std::vector<bool> free(22, false);
  for (const int j : {13, 16, 18, 20}) free[j] = true;
  const std::vector<Vec3> before = pose;
  kinematics::fit_free_joints(pose, target, free, skeleton.bone_lengths, skeleton);
  for (int j = 0; j < 22; ++j) {
    if (!free[j]) {
      EXPECT_EQ(pose[j], before[j]) << j;
      continue;
    }
    const Vec3 wanted = (target[j] - target[skeleton.parents[j]]).normalized();
    const Vec3 bone = pose[j] - pose[skeleton.parents[j]];
    EXPECT_LT((bone.normalized() - wanted).norm(), 1e-9);
    EXPECT_NEAR(bone.norm(), skeleton.bone_lengths[j], 1e-9);
  }
}

TEST(FitFreeJoints, ASpineBetweenFixedEndsKeepsItsLengths) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion walk = testing_support::make_walker(20);
  const std::vector<double> lengths = kinematics::mean_bone_lengths(walk, skeleton);
  std::vector<Vec3> pose = pose_of(walk, 5);
  const std::vector<Vec3> before = pose;
  std::vector<Vec3> target = pose;
  for (const int j : {0, 3, 6}) target[j] += Vec3(0.02, 0.3, -0.2);  // out of reach
  std::vector<bool> free(22, false);
  for (const int j : {0, 3, 6}) free[j] = true;
  kinematics::fit_free_joints(pose, target, free, lengths, skeleton);
  EXPECT_LT(worst_bone(pose, lengths), 1e-5);
  EXPECT_GT((pose[3] - before[3]).norm(), 0.005);
  EXPECT_LT((pose[0] - target[0]).norm(), (before[0] - target[0]).norm());
}

TEST(FitFreeJoints, AJointHeldFromAllSidesStays) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion walk = testing_support::make_walker(20);
  const std::vector<double> lengths = kinematics::mean_bone_lengths(walk, skeleton);
  std::vector<Vec3> pose = pose_of(walk, 5);
  const std::vector<Vec3> before = pose;
  std::vector<Vec3> target = pose_of(walk, 9);
  std::vector<bool> free(22, false);
  for (const int j : {9, 12, 15}) free[j] = true;  // 6, 13 and 14 stay
  kinematics::fit_free_joints(pose, target, free, lengths, skeleton);
  EXPECT_LT((pose[9] - before[9]).norm(), 1e-3);
  EXPECT_LT(worst_bone(pose, lengths), 1e-5);
}

TEST(BendJoint, ReachesTheEndWithBothBones) {
  Vec3 end(0, -0.5, 0.1);
  const Vec3 knee = kinematics::bend_joint(Vec3::Zero(), end, Vec3(0, -0.2, 0.3), 0.4, 0.42);
  EXPECT_EQ(end, Vec3(0, -0.5, 0.1));
  EXPECT_NEAR(knee.norm(), 0.4, 1e-12);
  EXPECT_NEAR((end - knee).norm(), 0.42, 1e-12);
  EXPECT_GT(knee.z(), 0.1);  // towards the hint
  Vec3 far_end(0, -2, 0);
  const Vec3 straight =
      kinematics::bend_joint(Vec3::Zero(), far_end, Vec3(0, -0.2, 0.3), 0.4, 0.42);
  EXPECT_NEAR(far_end.norm(), 0.82, 1e-3);
  EXPECT_NEAR((far_end - straight).norm(), 0.42, 1e-12);
}

}  // namespace
}  // namespace remomask
