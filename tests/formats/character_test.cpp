#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "formats/bvh.h"
#include "formats/mapped_kinematics.h"
#include "motion/canonical.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "remomask/rotations.h"
#include "rig/forward_kinematics.h"
#include "rig/joint_names.h"
#include "scenes/gltf_document.h"
#include "scenes/gltf_reader.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::make_walker;
using testing_support::temporary_folder;

namespace {

Motion walk_for_a_character() {
  return motion::canonicalize(make_walker(40, [](int t) { return 0.02 * t; }), humanml_skeleton());
}

std::string in_folder(const std::string& name) { return temporary_folder() + "/" + name; }

/// Our own figure, standing still in T-pose: a motion on it must be what it was.
std::string figure(const std::string& extension) {
  const std::string path = in_folder("figure" + extension);
  save_motion(path, motion::canonicalize(make_walker(2), humanml_skeleton()),
              {.common_skeleton = true});
  return path;
}

}  // namespace

TEST(Character, AMotionOnOurOwnFigureIsTheSameAndTheFigureStays) {
  const Motion motion = walk_for_a_character();
  MotionWriteOptions options;
  options.character = figure(".glb");
  const std::string path = in_folder("moved.glb");
  const WrittenMotion written = save_motion(path, motion, options);
  EXPECT_EQ(written.frames, 40);
  const Motion expected = rig::joint_positions(solve_rotations(motion));
  const rig::SourceMotion read = scenes::read_gltf(path);
  ASSERT_EQ(read.frames, 40);
  double worst = 0;
  for (int t = 0; t < read.frames; ++t) {
    const std::vector<Vec3> places = rig::world_positions(read, t);
    for (int j = 0; j < 22; ++j) {
      const int at = read.find_joint(rig::name_preset(JointNames::mixamo).joints[j]);
      ASSERT_GE(at, 0);
      worst = std::max(worst, (places[at] - joint_position(expected, t, j)).norm());
    }
  }
  EXPECT_LT(worst, 0.01) << "but for the hold of standing feet";
  const scenes::GltfDocument before(options.character), after(path);
  for (const char* list : {"nodes", "meshes", "skins", "materials", "scenes", "asset"}) {
    EXPECT_EQ(before.json()[list], after.json()[list]) << list;
  }
  EXPECT_TRUE(after.binary().starts_with(before.binary()));
}

TEST(Character, AFigureOfAnyKindGivesItsSkeletonAsBvh) {
  const Motion motion = walk_for_a_character();
  const Motion expected = rig::joint_positions(solve_rotations(motion));
  for (const char* extension : {".bvh", ".fbx", ".glb"}) {
    MotionWriteOptions options;
    options.character = figure(extension);
    const std::string path = in_folder("skeleton.bvh");
    save_motion(path, motion, options);
    const formats::Bvh bvh = formats::read_bvh(path);
    ASSERT_EQ(bvh.frames, 40) << extension;
    MotionFileOptions as_it_is;
    as_it_is.canonical = false;
    const Motion read = load_motion(path, as_it_is).motion;
    EXPECT_LT(testing_support::largest_difference(read, expected), 0.02) << extension;
  }
}

TEST(Character, WhatCannotBeDoneIsRefusedWithARemedy) {
  const Motion motion = walk_for_a_character();
  MotionWriteOptions options;
  options.character = figure(".bvh");
  EXPECT_THROW(save_motion(in_folder("x.glb"), motion, options), FileError);
  EXPECT_THROW(save_motion(in_folder("x.npy"), motion, options), Error);
  options.character = in_folder("absent.glb");
  EXPECT_THROW(save_motion(in_folder("x.glb"), motion, options), FileError);
}

}  // namespace remomask
