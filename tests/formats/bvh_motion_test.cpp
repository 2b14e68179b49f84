// What a written BVH file says, read by nothing but the definition of the format.
#include "formats/bvh_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "base/file.h"
#include "formats/motion_writing.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "rig/forward_kinematics.h"
#include "rig/joint_names.h"
#include "rig/written_rotations.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::largest_difference;
using testing_support::make_walker;
using testing_support::temporary_folder;

namespace {

struct TextJoint {
  std::string name;
  int parent = -1;
  Vec3 offset;
  std::vector<std::string> channels;
  std::optional<Vec3> end;
};

struct TextBvh {
  std::vector<TextJoint> joints;
  int frames = 0;
  double frame_time = 0;
  std::vector<std::vector<double>> rows;

  /// Names to positions. A position channel is added to the OFFSET, as three.js does; Blender puts
  /// it in its place, which is the same where the OFFSET is zero.
  std::map<std::string, Vec3> pose(const std::vector<double>& row) const {
    std::vector<Eigen::Isometry3d> world;
    std::map<std::string, Vec3> positions;
    size_t at = 0;
    for (const TextJoint& joint : joints) {
      Eigen::Isometry3d local = Eigen::Isometry3d::Identity();
      local.translate(joint.offset);
      for (const std::string& channel : joint.channels) {
        const double value = row.empty() ? 0 : row[at++];
        const Vec3 axis = channel[0] == 'X'   ? Vec3::UnitX()
                          : channel[0] == 'Y' ? Vec3::UnitY()
                                              : Vec3::UnitZ();
        if (channel.ends_with("position")) {
          local.pretranslate(axis * value);
        } else {
          local.rotate(Eigen::AngleAxisd(value * std::numbers::pi / 180, axis));
        }
      }
      world.push_back(joint.parent < 0 ? local : world[static_cast<size_t>(joint.parent)] * local);
      positions[joint.name] = world.back().translation();
      if (joint.end) positions["end of " + joint.name] = world.back() * *joint.end;
    }
    return positions;
  }
};

TextBvh read_text(const std::string& text) {
  TextBvh bvh;
  std::istringstream in(text);
  std::vector<int> open;
  bool in_end = false;
  const auto vector = [&] {
    Vec3 v;
    in >> v.x() >> v.y() >> v.z();
    return v;
  };
  for (std::string word; in >> word;) {
    if (word == "ROOT" || word == "JOINT") {
      TextJoint joint;
      in >> joint.name;
      joint.parent = open.empty() ? -1 : open.back();
      bvh.joints.push_back(joint);
    } else if (word == "End") {
      in >> word;
      in_end = true;
    } else if (word == "{") {
      open.push_back(static_cast<int>(bvh.joints.size()) - 1);
    } else if (word == "}") {
      open.pop_back();
      in_end = false;
    } else if (word == "OFFSET") {
      if (in_end) {
        bvh.joints.back().end = vector();
      } else {
        bvh.joints.back().offset = vector();
      }
    } else if (word == "CHANNELS") {
      size_t count = 0;
      in >> count;
      bvh.joints.back().channels.resize(count);
      for (std::string& channel : bvh.joints.back().channels) in >> channel;
    } else if (word == "Frames:") {
      in >> bvh.frames;
    } else if (word == "Time:") {
      in >> bvh.frame_time;
      break;
    }
  }
  size_t channels = 0;
  for (const TextJoint& joint : bvh.joints) channels += joint.channels.size();
  for (std::vector<double> row(channels);; bvh.rows.push_back(row)) {
    for (double& value : row) in >> value;
    if (!in) break;
  }
  return bvh;
}

TextBvh written(const Motion& motion, const MotionWriteOptions& options = {}) {
  const std::string path = temporary_folder() + "/written.bvh";
  save_motion(path, motion, options);
  return read_text(read_file(path));
}

Motion turning_walker(int frames) {
  return make_walker(frames, [](int t) { return 0.07 * t; });
}

}  // namespace

TEST(WrittenBvh, OnlyTheRootHasPositions) {
  const TextBvh bvh = written(turning_walker(20));
  ASSERT_EQ(bvh.joints.size(), 23u);
  EXPECT_EQ(bvh.joints[0].name, "Root");
  EXPECT_EQ(bvh.joints[0].offset, Vec3(0, 0, 0));
  EXPECT_EQ(bvh.joints[0].channels.size(), 6u);
  EXPECT_EQ(bvh.joints[1].name, "Hips");
  EXPECT_GT(bvh.joints[1].offset.y(), 80);
  int ends = 0;
  for (size_t j = 1; j < bvh.joints.size(); ++j) {
    EXPECT_EQ(bvh.joints[j].channels.size(), 3u) << bvh.joints[j].name;
    ends += bvh.joints[j].end.has_value();
  }
  EXPECT_EQ(ends, 5);
  EXPECT_EQ(bvh.frames, 20);
  EXPECT_EQ(bvh.rows.size(), 20u);
  EXPECT_DOUBLE_EQ(bvh.frame_time, 0.05);
}

TEST(WrittenBvh, TheRestPoseStandsOnTheFloor) {
  const TextBvh bvh = written(make_walker(3));
  double lowest = 1e9, highest = -1e9;
  for (const auto& [name, position] : bvh.pose({})) {
    lowest = std::min(lowest, position.y());
    highest = std::max(highest, position.y());
  }
  EXPECT_NEAR(lowest, 0, 1e-3);
  EXPECT_GT(highest, 150);
  EXPECT_LT(highest, 190);
  EXPECT_GT(bvh.pose({}).at("LeftHand").x(), 50);
  EXPECT_GT(bvh.pose({}).at("end of LeftToeBase").z(), 5);
}

TEST(WrittenBvh, EveryJointIsWhereTheMotionHasIt) {
  const Motion motion = turning_walker(60);
  const Motion rigid = rig::joint_positions(solve_rotations(motion, {.keep_rigid = true}));
  for (const bool root_motion : {false, true}) {
    const TextBvh bvh = written(motion, {.root_motion = root_motion});
    const rig::NamePreset& names = rig::name_preset(JointNames::mixamo);
    for (int t = 0; t < motion.frames; ++t) {
      const auto pose = bvh.pose(bvh.rows[static_cast<size_t>(t)]);
      for (int j = 0; j < 22; ++j) {
        const Vec3 there = pose.at(std::string(names.joints[static_cast<size_t>(j)])) / 100;
        EXPECT_LT((there - joint_position(rigid, t, j)).norm(), 2e-5) << t << " " << j;
      }
    }
  }
}

TEST(WrittenBvh, AnglesRunOnInsteadOfJumping) {
  const TextBvh bvh = written(make_walker(90, [](int t) { return 0.1 * t; }));
  for (size_t t = 1; t < bvh.rows.size(); ++t) {
    for (size_t c = 3; c < bvh.rows[t].size(); ++c) {
      EXPECT_LT(std::abs(bvh.rows[t][c] - bvh.rows[t - 1][c]), 60) << t << " " << c;
    }
  }
}

TEST(WrittenBvh, TakesNamesRateAndUnit) {
  const Motion motion = make_walker(21);
  const TextBvh bvh =
      written(motion, {.names = JointNames::unreal, .fps = 30.0, .units = LengthUnit::metres});
  EXPECT_EQ(bvh.joints[0].name, "root");
  EXPECT_EQ(bvh.joints[1].name, "pelvis");
  EXPECT_LT(bvh.joints[1].offset.y(), 1.2);
  EXPECT_EQ(bvh.frames, 31);
  EXPECT_NEAR(bvh.frame_time, 1 / 30.0, 1e-6);
}

TEST(WrittenBvh, ComesBackUnderEveryNameAtEveryRate) {
  const std::string path = temporary_folder() + "/back.bvh";
  const Motion motion = rig::joint_positions(
      solve_rotations(make_walker(41, [](int t) { return 0.02 * t; }), {.keep_rigid = true}));
  MotionFileOptions as_it_is;
  as_it_is.canonical = false;
  for (const rig::NamePreset& preset : rig::name_presets()) {
    for (const double fps : {20.0, 60.0}) {
      save_motion(path, motion, {.names = preset.names, .fps = fps});
      const LoadedMotion back = load_motion(path, as_it_is);
      EXPECT_EQ(back.skeleton_map, "remomask");
      EXPECT_LT(largest_difference(back.motion, motion), 2e-4) << preset.option << " " << fps;
    }
  }
}

TEST(WrittenBvh, RefusesChoicesThatHaveNoMeaning) {
  const std::string npy = temporary_folder() + "/choices.npy";
  const Motion motion = make_walker(21);
  const WrittenMotion half = save_motion(npy, motion, {.fps = 40.0});
  EXPECT_EQ(half.frames, 41);
  EXPECT_EQ(half.fps, 40);
  MotionWriteOptions refused[6];
  refused[0].names = JointNames::vrm;
  refused[1].units = LengthUnit::metres;
  refused[2].in_place = true;
  refused[3].loop = true;
  refused[4].root_motion = true;
  refused[5].fps = 300;
  for (const MotionWriteOptions& options : refused) {
    EXPECT_THROW(save_motion(npy, motion, options), Error);
  }
  try {
    save_motion(npy, motion, refused[0]);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("--names"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(".npy"), std::string::npos) << error.what();
  }
}

}  // namespace remomask
