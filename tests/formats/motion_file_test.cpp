#include "remomask/motion_file.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/file.h"
#include "formats/axis_detection.h"
#include "formats/bvh_motion.h"
#include "formats/motion_writing.h"
#include "formats/npy.h"
#include "motion/canonical.h"
#include "motion/features.h"
#include "remomask/error.h"
#include "rig/forward_kinematics.h"
#include "rig/written_rotations.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::largest_difference;
using testing_support::make_walker;
using testing_support::moved;
using testing_support::temporary_folder;

namespace {

std::string temporary(const std::string& name) { return temporary_folder() + "/" + name; }

Motion canonical_walker(int frames) {
  return motion::canonicalize(make_walker(frames, [](int t) { return 0.02 * t; }),
                              humanml_skeleton());
}

/// The same on the rigid skeleton, which rotations give back exactly.
Motion rigid_walker(int frames) {
  return motion::canonicalize(rig::joint_positions(solve_rotations(canonical_walker(frames))),
                              humanml_skeleton());
}

formats::Bvh bvh_of(const Motion& motion) {
  return formats::rotations_to_bvh(rig::rotations_to_write(motion, {}).motion, 100);
}

/// Positions as a file of another program would hold them.
Motion disguised(const Motion& motion, double metres_per_unit, char up_axis) {
  Motion result = motion;
  for (int t = 0; t < motion.frames; ++t) {
    for (int j = 0; j < motion.joints; ++j) {
      const Vec3 p = joint_position(motion, t, j) / metres_per_unit;
      set_joint_position(result, t, j,
                         up_axis == 'Z'   ? Vec3(p.x(), -p.z(), p.y())
                         : up_axis == 'X' ? Vec3(p.y(), -p.x(), p.z())
                                          : p);
    }
  }
  return result;
}

void write_joints(const std::string& path, const Motion& motion) {
  write_file_atomically(
      path, formats::format_npy({{static_cast<size_t>(motion.frames), 22, 3}, motion.positions}));
}

}  // namespace

TEST(MotionFile, NpyAndBvhRoundTrips) {
  const Motion motion = rigid_walker(60);
  save_motion(temporary("a.npy"), motion);
  EXPECT_LT(largest_difference(load_motion(temporary("a.npy")).motion, motion), 2e-6);
  save_motion(temporary("a.bvh"), motion);
  const LoadedMotion loaded = load_motion(temporary("a.bvh"));
  EXPECT_LT(largest_difference(loaded.motion, motion), 1e-3);
  EXPECT_EQ(loaded.skeleton_map, "remomask");
  EXPECT_EQ(loaded.up_axis, 'Y');
  EXPECT_DOUBLE_EQ(loaded.metres_per_unit, 0.01);
  EXPECT_NEAR(loaded.source_fps, 20, 1e-9);
  EXPECT_EQ(loaded.source_frames, 60);
  EXPECT_FALSE(std::filesystem::exists(temporary("a.npy.json")));
}

TEST(MotionFile, FeaturesAreRead) {
  const Motion motion = canonical_walker(60);
  const motion::Features f = motion::extract_features_all_frames(motion, humanml_skeleton(),
                                                                 motion::FeatureMode::official);
  write_file_atomically(temporary("f.npy"), formats::format_npy({{60, 263}, f.values}));
  EXPECT_LT(largest_difference(load_motion(temporary("f.npy")).motion, motion), 2e-5);
}

TEST(MotionFile, TheSidecarLiesBesideTheFileAndNeverOutlivesItsMotion) {
  const nlohmann::json sidecar = {{"sentence", "a \"tall\" person\nwaves"}, {"frames", 4}};
  formats::write_motion(temporary("m.bvh"), canonical_walker(4), &sidecar);
  auto written = nlohmann::json::parse(read_file(temporary("m.bvh.json")));
  EXPECT_EQ(written.at("motion_hash").get<std::string>().size(), 32u);
  written.erase("motion_hash");
  written.erase("checksum");
  EXPECT_EQ(written, sidecar);
  save_motion(temporary("m.bvh"), canonical_walker(5));
  EXPECT_FALSE(std::filesystem::exists(temporary("m.bvh.json")));
}

TEST(MotionFile, FindsUnitAndUpAxis) {
  const Motion motion = canonical_walker(60);
  for (const double unit : {1.0, 0.01, 0.001, 0.0254, 0.056444}) {
    for (const char axis : {'X', 'Y', 'Z'}) {
      write_joints(temporary("d.npy"), disguised(motion, unit, axis));
      const LoadedMotion loaded = load_motion(temporary("d.npy"));
      EXPECT_EQ(loaded.up_axis, axis);
      EXPECT_DOUBLE_EQ(loaded.metres_per_unit, unit);
      EXPECT_LT(largest_difference(loaded.motion, motion), 1e-5) << unit << axis;
    }
  }
}

TEST(MotionFile, ChoicesOfTheCallerWin) {
  const Motion motion = canonical_walker(60);
  write_joints(temporary("o.npy"), disguised(motion, 0.01, 'Y'));
  MotionFileOptions options;
  options.up_axis = 'Z';
  options.metres_per_unit = 0.02;
  options.skip_frames = 5;
  const LoadedMotion loaded = load_motion(temporary("o.npy"), options);
  EXPECT_EQ(loaded.up_axis, 'Z');
  EXPECT_DOUBLE_EQ(loaded.metres_per_unit, 0.02);
  EXPECT_EQ(loaded.motion.frames, 55);
  EXPECT_EQ(loaded.source_frames, 60);
}

TEST(MotionFile, ACrawlerDoesNotTurnTheWorldOver) {
  const Motion walker = make_walker(60);
  Motion crawler = walker;
  for (size_t i = 0; i < crawler.positions.size(); i += 3) {  // lies on the belly, head to +Z
    const float y = walker.positions[i + 1], z = walker.positions[i + 2];
    crawler.positions[i + 1] = 0.3f - z;
    crawler.positions[i + 2] = y;
  }
  const Motion standing = slice(walker, 0, 1);
  EXPECT_EQ(formats::detect_up_axis(crawler, &standing), 'Y');
  EXPECT_EQ(formats::detect_up_axis(walker, nullptr), 'Y');
}

TEST(MotionFile, ResamplesOtherFrameRates) {
  formats::Bvh bvh = bvh_of(canonical_walker(61));
  bvh.frame_time = 1.0 / 120;
  write_file_atomically(temporary("fast.bvh"), formats::format_bvh(bvh));
  const LoadedMotion loaded = load_motion(temporary("fast.bvh"));
  EXPECT_EQ(loaded.motion.frames, 11);
  EXPECT_NEAR(loaded.source_fps, 120, 0.1);
}

TEST(MotionFile, TakesAMapFileOfTheUser) {
  const Motion walk = rigid_walker(20);
  formats::Bvh bvh = bvh_of(walk);
  nlohmann::json map;
  // Root, pelvis, left leg, right leg, spine, head, left arm, right arm: as the file nests them.
  const int order[] = {0, 1,  4,  7,  10, 2,  5,  8,  11, 3,  6,
                       9, 12, 15, 13, 16, 18, 20, 14, 17, 19, 21};
  for (size_t k = 0; k < bvh.joints.size(); ++k) {
    bvh.joints[k].name = "part " + std::to_string(k);
    if (k > 0) map[humanml_skeleton().joint_names[order[k - 1]]] = bvh.joints[k].name;
  }
  write_file_atomically(temporary("mine.bvh"), formats::format_bvh(bvh));
  write_file_atomically(temporary("mine.json"), map.dump());
  MotionFileOptions options;
  options.skeleton_map = temporary("mine.json");
  const LoadedMotion loaded = load_motion(temporary("mine.bvh"), options);
  EXPECT_EQ(loaded.skeleton_map, "mine");
  EXPECT_LT(largest_difference(loaded.motion, walk), 1e-3);
  options.skeleton_map = "bandai";  // shipped, but of another skeleton
  EXPECT_THROW(load_motion(temporary("mine.bvh"), options), FileError);
  options.skeleton_map = "no such map";
  EXPECT_THROW(load_motion(temporary("mine.bvh"), options), FileError);
}

TEST(MotionFile, RefusesUnusableFilesAndOptions) {
  const Motion motion = canonical_walker(6);
  EXPECT_THROW(save_motion(temporary("a.abc"), motion), FileError);
  EXPECT_THROW(save_motion(temporary("no/such/folder/a.npy"), motion), FileError);
  EXPECT_THROW(save_motion(temporary("a.npy"), Motion(3, 21)), Error);
  EXPECT_THROW(load_motion(temporary("absent.bvh")), FileError);
  EXPECT_THROW(load_motion(temporary("a.abc")), FileError);
  write_file_atomically(temporary("shape.npy"),
                        formats::format_npy({{2, 5}, std::vector<float>(10)}));
  EXPECT_THROW(load_motion(temporary("shape.npy")), FileError);
  Motion broken = motion;
  broken.at(2, 2)[1] = NAN;
  write_joints(temporary("nan.npy"), broken);
  EXPECT_THROW(load_motion(temporary("nan.npy")), FileError);
  save_motion(temporary("b.npy"), motion);
  MotionFileOptions options;
  options.skip_frames = 6;
  EXPECT_THROW(load_motion(temporary("b.npy"), options), FileError);
  options.skip_frames = -1;
  EXPECT_THROW(load_motion(temporary("b.npy"), options), Error);
  options.skip_frames = 0;
  options.up_axis = 'y';
  EXPECT_THROW(load_motion(temporary("b.npy"), options), Error);
  options.up_axis = 'Y';
  options.metres_per_unit = 0;
  EXPECT_THROW(load_motion(temporary("b.npy"), options), Error);
}

TEST(MotionFile, PlaceAndSizeStayWhereCanonicalIsNotAskedFor) {
  const Motion walk = moved(make_walker(30), 0.8, Vec3(2, 0.5, -3), 1.07);
  MotionFileOptions as_it_is;
  as_it_is.canonical = false;
  save_motion(temporary("placed.npy"), walk);
  EXPECT_EQ(load_motion(temporary("placed.npy"), as_it_is).motion.positions, walk.positions);
  EXPECT_GT(largest_difference(load_motion(temporary("placed.npy")).motion, walk), 1);
  // A BVH file is on the common skeleton unless the performer's own proportions are asked for.
  save_motion(temporary("placed.bvh"), walk, {.own_proportions = true});
  const Motion back = load_motion(temporary("placed.bvh"), as_it_is).motion;
  EXPECT_LT(largest_difference(back, walk), 2e-4);
}

}  // namespace remomask
