#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <assimp/Importer.hpp>
#include <nlohmann/json.hpp>

#include "motion/canonical.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "remomask/rotations.h"
#include "rig/forward_kinematics.h"
#include "rig/joint_names.h"
#include "rig/source_motion.h"
#include "scenes/fbx_reader.h"
#include "scenes/gltf_reader.h"
#include "tests/formats/scene_positions.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::make_walker;
using testing_support::node_position;
using testing_support::temporary_folder;

namespace {

const char* const kNames[22] = {
    "Hips",        "LeftUpLeg",    "RightUpLeg",    "Spine",    "LeftLeg",     "RightLeg",
    "Spine1",      "LeftFoot",     "RightFoot",     "Spine2",   "LeftToeBase", "RightToeBase",
    "Neck",        "LeftShoulder", "RightShoulder", "Head",     "LeftArm",     "RightArm",
    "LeftForeArm", "RightForeArm", "LeftHand",      "RightHand"};

Motion walk_of(int frames) {
  return motion::canonicalize(make_walker(frames, [](int t) { return 0.02 * t; }),
                              humanml_skeleton());
}

std::string vrm_name(int joint) {
  return std::string(rig::name_preset(JointNames::vrm).joints[static_cast<size_t>(joint)]);
}

/// The motion as it is written: on the rigid skeleton.
Motion on_its_skeleton(const Motion& motion) {
  return rig::joint_positions(solve_rotations(motion, {.keep_rigid = true}));
}

/// Greatest distance between the joints of a file's motion and those that were written.
double worst_joint(const rig::SourceMotion& read, const Motion& expected) {
  double worst = 0;
  for (int t = 0; t < expected.frames; ++t) {
    const std::vector<Vec3> places = rig::world_positions(read, t);
    for (int j = 0; j < 22; ++j) {
      const int named = read.find_joint(kNames[j]);
      const int at = named < 0 ? read.find_joint(vrm_name(j)) : named;
      if (at < 0) return 1e9;
      worst = std::max(worst, (places[at] - joint_position(expected, t, j)).norm());
    }
  }
  return worst;
}

std::string written(const std::string& extension, const Motion& motion) {
  const std::string path = temporary_folder() + "/walk" + extension;
  save_motion(path, motion);
  return path;
}

}  // namespace

TEST(Gltf, AWrittenFileIsReadBackWithItsJoints) {
  const Motion motion = walk_of(60);
  for (const char* extension : {".glb", ".vrma"}) {
    const rig::SourceMotion read = scenes::read_gltf(written(extension, motion));
    EXPECT_EQ(read.frames, 60);
    EXPECT_DOUBLE_EQ(read.fps, 20);
    EXPECT_EQ(read.joints[0].parent, -1);
    EXPECT_LT(worst_joint(read, on_its_skeleton(motion)), 1e-4) << extension;
    double lowest = 1;
    for (const Vec3& place : rig::world_positions(read, -1)) {
      lowest = std::min(lowest, place.y());
    }
    EXPECT_NEAR(lowest, 0, 1e-6) << "the rest pose stands on the floor";
  }
}

/// assimp has every joint where the motion has it.
void expect_joints_of(const Motion& motion, const aiScene& scene) {
  const Motion expected = on_its_skeleton(motion);
  for (const int t : {0, 13, 39}) {
    for (int j = 0; j < 22; ++j) {
      EXPECT_LT((node_position(scene, 0, kNames[j], t) - joint_position(expected, t, j)).norm(),
                1e-3)
          << kNames[j] << " " << t;
    }
  }
}

TEST(Gltf, AssimpFindsTheSameJoints) {
  const Motion motion = walk_of(40);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(written(".glb", motion), 0);
  ASSERT_TRUE(scene) << importer.GetErrorString();
  expect_joints_of(motion, *scene);
  ASSERT_EQ(scene->mNumMeshes, 2U);
  EXPECT_EQ(scene->mMeshes[0]->mNumBones, 23U);
}

TEST(Gltf, FbxHoldsTheSameJoints) {
  const Motion motion = walk_of(40);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(written(".fbx", motion), 0);
  ASSERT_TRUE(scene) << importer.GetErrorString();
  expect_joints_of(motion, *scene);
  const rig::SourceMotion read = scenes::read_fbx(written(".fbx", motion));
  EXPECT_EQ(read.frames, 40);
  EXPECT_NEAR(read.fps, 20, 1e-6);
  EXPECT_EQ(read.metres_per_unit, 1);
  EXPECT_LT(worst_joint(read, on_its_skeleton(motion)), 1e-3);
}

}  // namespace remomask
