#include "formats/npz.h"

#include <archive.h>
#include <archive_entry.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/file.h"
#include "formats/amass.h"
#include "formats/smpl_rest.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::largest_difference;
using testing_support::make_walker;
using testing_support::temporary_folder;

namespace {

using Entries = std::vector<std::pair<std::string, std::string>>;

/// A zip file as numpy.savez_compressed makes it.
std::string write_zip(const std::string& name, const Entries& entries) {
  const std::string path = temporary_folder() + "/" + name;
  struct archive* zip = archive_write_new();
  archive_write_set_format_zip(zip);
  EXPECT_EQ(archive_write_open_filename(zip, path.c_str()), ARCHIVE_OK);
  for (const auto& [entry_name, content] : entries) {
    struct archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, entry_name.c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(content.size()));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_write_header(zip, entry);
    archive_write_data(zip, content.data(), content.size());
    archive_entry_free(entry);
  }
  archive_write_free(zip);
  return path;
}

std::string npy(const std::vector<size_t>& shape, const std::vector<float>& values) {
  return formats::format_npy({shape, values});
}

std::string npy_of_objects() {
  std::string content = npy({}, {1});
  content.replace(content.find("<f4"), 3, "|O ");
  return content.replace(content.find("|O '"), 4, "|O' ");
}

std::string npz_refusal(const std::string& path, const MotionFileOptions& options = {}) {
  try {
    load_motion(path, options);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

bool npz_mentions(const std::vector<std::string>& warnings, const std::string& part) {
  for (const std::string& warning : warnings) {
    if (warning.find(part) != std::string::npos) return true;
  }
  return false;
}

/// A quarter turn about X: Y up to Z up.
constexpr float kStandUp = std::numbers::pi_v<float> / 2;

/// 40 frames of an AMASS file: a body that stands, Z up, walks along its X and bends its left
/// elbow.
struct AmassData {
  explicit AmassData(size_t joints) : width(3 * joints), poses(40 * width), trans(40 * 3) {
    for (size_t t = 0; t < 40; ++t) {
      poses[t * width] = kStandUp;
      poses[t * width + 3 * 18 + 1] = -0.02f * static_cast<float>(t);  // left elbow, about Y
      trans[t * 3] = 0.03f * static_cast<float>(t);
      trans[t * 3 + 2] = 0.9f;
    }
  }
  std::string poses_npy() const { return npy({40, width}, poses); }
  std::string trans_npy() const { return npy({40, 3}, trans); }
  size_t width;
  std::vector<float> poses, trans;
};

/// The turns of some joints as rotation matrices.
std::vector<float> matrices(const AmassData& data, size_t first, size_t end) {
  std::vector<float> values;
  for (size_t t = 0; t < 40; ++t) {
    for (size_t joint = first; joint < end; ++joint) {
      const float* p = data.poses.data() + t * data.width + 3 * joint;
      const Vec3 turn(p[0], p[1], p[2]);
      Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
      if (turn.norm() > 0) matrix = Eigen::AngleAxisd(turn.norm(), turn.normalized());
      for (int i = 0; i < 9; ++i) values.push_back(static_cast<float>(matrix(i / 3, i % 3)));
    }
  }
  return values;
}

}  // namespace

TEST(Npz, ReadsOnlyTheArraysThatAreWanted) {
  const std::string path = write_zip("some.npz", {{"a.npy", npy({2}, {1, 2})},
                                                  {"gender.npy", npy_of_objects()},
                                                  {"b.npy", npy({}, {3})},
                                                  {"notes.txt", "no array"}});
  const formats::NpzArrays npz = formats::read_npz(path, {"b", "c", "a"});
  EXPECT_EQ(npz.arrays.size(), 2u);
  EXPECT_EQ(npz.find("a")->values, (std::vector<float>{1, 2}));
  EXPECT_EQ(npz.find("b")->values, (std::vector<float>{3}));
  EXPECT_EQ(npz.find("c"), nullptr);
  EXPECT_EQ(npz.names, (std::vector<std::string>{"a", "gender", "b"}));
  try {
    formats::read_npz(path, {"gender"});
    ADD_FAILURE() << "was accepted";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("nothing of it was executed"), std::string::npos);
  }
}

TEST(Npz, DamagedFilesAndBombsAreRefused) {
  const std::string path = write_zip("whole.npz", {{"joints.npy", npy({4}, {1, 2, 3, 4})}});
  const std::string content = read_file(path);
  const std::string broken = temporary_folder() + "/broken.npz";
  for (size_t length = 0; length < content.size(); length += 7) {
    write_file_atomically(broken, content.substr(0, length));
    EXPECT_THROW(formats::read_npz(broken, {"joints"}), FileError) << length;
  }
  write_file_atomically(broken, "no zip at all");
  EXPECT_THROW(formats::read_npz(broken, {"joints"}), FileError);
  EXPECT_THROW(formats::read_npz(temporary_folder() + "/absent.npz", {}), FileError);
  const std::string bomb = write_zip(
      "bomb.npz",
      {{"a.npy", npy({2, 1 << 19}, std::vector<float>(1 << 20))}, {"b.npy", npy({2}, {1, 2})}});
  EXPECT_LT(read_file(bomb).size(), 100u << 10);
  EXPECT_EQ(formats::read_npz(bomb, {"a", "b"}).arrays.size(), 2u);
  for (const formats::NpzLimits& limits :
       {formats::NpzLimits{3 << 20, 1 << 30}, formats::NpzLimits{1 << 30, 3 << 20}}) {
    try {
      formats::read_npz(bomb, {"a", "b"}, limits);
      ADD_FAILURE() << "was accepted";
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("unpacks to more than 3 MiB"), std::string::npos);
    }
    EXPECT_EQ(formats::read_npz(bomb, {"b"}, limits).arrays.size(), 1u);
  }
}

TEST(Npz, ArraysOfJoints) {
  const Motion motion = make_walker(30);
  MotionFileOptions as_it_is;
  as_it_is.canonical = false;
  for (const char* name :
       {"joints.npy", "positions.npy", "arr_0.npy", "joints3d.npy", "motion.npy"}) {
    const std::string path = write_zip("joints.npz", {{name, npy({30, 22, 3}, motion.positions)}});
    const LoadedMotion loaded = load_motion(path, as_it_is);
    EXPECT_EQ(largest_difference(loaded.motion, motion), 0) << name;
    EXPECT_TRUE(npz_mentions(loaded.warnings, "no frame rate")) << name;
  }
  const std::string path = write_zip(
      "rate.npz", {{"joints.npy", npy({30, 22, 3}, motion.positions)}, {"fps.npy", npy({}, {10})}});
  EXPECT_EQ(load_motion(path).motion.frames, 59);
  as_it_is.fps = 40;
  EXPECT_EQ(load_motion(path, as_it_is).motion.frames, 15);
}

TEST(Npz, PosesGoBeforeArraysOfALooseName) {
  const AmassData data(52);
  const std::string path = write_zip("both.npz", {{"poses.npy", data.poses_npy()},
                                                  {"trans.npy", data.trans_npy()},
                                                  {"motion.npy", npy_of_objects()},
                                                  {"mocap_framerate.npy", npy({}, {20})}});
  EXPECT_EQ(load_motion(path).motion.frames, 40);
}

TEST(Npz, ObjectsAndOtherArraysAreRefused) {
  const std::string objects = write_zip("objects.npz", {{"poses.npy", npy_of_objects()}});
  EXPECT_NE(npz_refusal(objects).find("poses: holds Python objects"), std::string::npos)
      << npz_refusal(objects);
  const std::string other = write_zip("other.npz", {{"betas.npy", npy({3}, {1, 2, 3})}});
  EXPECT_NE(npz_refusal(other).find("only the arrays \"betas\""), std::string::npos)
      << npz_refusal(other);
}

TEST(Amass, BothSpellingsAndAllBodiesReadTheSame) {
  const AmassData smplh(52), smpl(24), smplx(55);
  std::vector<float> root, body;
  for (size_t t = 0; t < 40; ++t) {
    const float* row = smplh.poses.data() + t * smplh.width;
    root.insert(root.end(), row, row + 3);
    body.insert(body.end(), row + 3, row + 66);
  }
  const std::string betas = npy({16}, std::vector<float>(16));
  const std::string rate = npy({}, {60});
  const std::string paths[] = {
      write_zip("old.npz", {{"poses.npy", smplh.poses_npy()},
                            {"trans.npy", smplh.trans_npy()},
                            {"betas.npy", betas},
                            {"mocap_framerate.npy", rate}}),
      write_zip("new.npz", {{"poses.npy", smplh.poses_npy()},
                            {"trans.npy", smplh.trans_npy()},
                            {"mocap_frame_rate.npy", rate}}),
      write_zip("smpl.npz", {{"poses.npy", smpl.poses_npy()},
                             {"trans.npy", smpl.trans_npy()},
                             {"mocap_framerate.npy", rate}}),
      write_zip("batch.npz", {{"pose.npy", npy({1, 40, 72}, smpl.poses)},
                              {"trans.npy", npy({1, 40, 3}, smpl.trans)},
                              {"mocap_framerate.npy", rate}}),
      write_zip("matrices.npz", {{"global_orient.npy", npy({40, 1, 3, 3}, matrices(smpl, 0, 1))},
                                 {"body_pose.npy", npy({40, 21, 3, 3}, matrices(smpl, 1, 22))},
                                 {"transl.npy", smpl.trans_npy()},
                                 {"mocap_framerate.npy", rate}}),
      write_zip("smplx.npz", {{"root_orient.npy", npy({40, 3}, root)},
                              {"pose_body.npy", npy({40, 63}, body)},
                              {"poses.npy", smplx.poses_npy()},
                              {"trans.npy", smplx.trans_npy()},
                              {"mocap_frame_rate.npy", rate}}),
  };
  const LoadedMotion first = load_motion(paths[0]);
  ASSERT_EQ(first.motion.frames, 14);  // 39 steps at 60 fps
  EXPECT_EQ(first.up_axis, 'Z');
  EXPECT_EQ(first.metres_per_unit, 1);
  EXPECT_TRUE(npz_mentions(first.warnings, "betas"));
  for (const std::string& path : paths) {
    EXPECT_LT(largest_difference(load_motion(path).motion, first.motion), 1e-5) << path;
  }
  MotionFileOptions faster;
  faster.fps = 120;
  EXPECT_EQ(load_motion(paths[0], faster).motion.frames, 7);
}

TEST(Amass, JointsFollowByForwardKinematics) {
  const AmassData data(52);
  const std::string path = write_zip("fk.npz", {{"poses.npy", data.poses_npy()},
                                                {"trans.npy", data.trans_npy()},
                                                {"mocap_framerate.npy", npy({}, {20})}});
  MotionFileOptions as_it_is;
  as_it_is.canonical = false;
  const Motion motion = load_motion(path, as_it_is).motion;
  ASSERT_EQ(motion.frames, 40);
  const auto& rest = formats::smpl_rest_offsets();
  // Z up to Y up undoes the quarter turn: the body stands as it rests, and moves along X.
  const Vec3 pelvis(0.03 * 39, 0.9, 0);
  EXPECT_LT((joint_position(motion, 39, 0) - pelvis).norm(), 1e-5);
  EXPECT_LT((joint_position(motion, 39, 1) - pelvis - rest[1]).norm(), 1e-5);
  const Vec3 elbow = pelvis + rest[3] + rest[6] + rest[9] + rest[13] + rest[16] + rest[18];
  EXPECT_LT((joint_position(motion, 39, 18) - elbow).norm(), 1e-5);
  const Vec3 forearm = Eigen::AngleAxisd(-0.02 * 39, Vec3::UnitY()) * rest[20];
  EXPECT_LT((joint_position(motion, 39, 20) - elbow - forearm).norm(), 1e-5);
  // A T-pose: left hand at the left, arms level, head above, feet below and forward.
  EXPECT_GT(joint_position(motion, 0, 20).x(), 0.6);
  EXPECT_NEAR(joint_position(motion, 0, 20).y(), joint_position(motion, 0, 16).y(), 0.05);
  EXPECT_GT(joint_position(motion, 0, 15).y() - joint_position(motion, 0, 10).y(), 1.3);
  EXPECT_GT(joint_position(motion, 0, 10).z(), joint_position(motion, 0, 7).z() + 0.1);
}

TEST(Amass, WhatIsMissingOrWrongIsNamed) {
  const AmassData data(52);
  const std::string poses = data.poses_npy(), trans = data.trans_npy(), rate = npy({}, {60});
  const LoadedMotion unrated =
      load_motion(write_zip("a.npz", {{"poses.npy", poses}, {"trans.npy", trans}}));
  EXPECT_TRUE(npz_mentions(unrated.warnings, "no frame rate"));
  const LoadedMotion still =
      load_motion(write_zip("b.npz", {{"poses.npy", poses}, {"mocap_framerate.npy", rate}}));
  EXPECT_TRUE(npz_mentions(still.warnings, "no array trans"));
  EXPECT_NE(npz_refusal(write_zip("c.npz", {{"poses.npy", npy({40, 63}, std::vector<float>(2520))},
                                            {"mocap_framerate.npy", rate}}))
                .find("66, 72, 156 or 165"),
            std::string::npos);
  EXPECT_NE(npz_refusal(write_zip("d.npz", {{"poses.npy", poses},
                                            {"trans.npy", npy({39, 3}, std::vector<float>(117))}}))
                .find("trans has shape (39, 3)"),
            std::string::npos);
  AmassData broken(52);
  broken.poses[5 * broken.width + 7] = NAN;
  EXPECT_NE(npz_refusal(write_zip("e.npz", {{"poses.npy", broken.poses_npy()}})).find("frame 5"),
            std::string::npos);
  // Zero poses stand along Y, which AMASS never does.
  const LoadedMotion zero =
      load_motion(write_zip("f.npz", {{"poses.npy", npy({30, 156}, std::vector<float>(30 * 156))},
                                      {"trans.npy", npy({30, 3}, std::vector<float>(90))},
                                      {"mocap_frame_rate.npy", rate}}));
  EXPECT_EQ(zero.up_axis, 'Y');
  EXPECT_TRUE(npz_mentions(zero.warnings, "--up-axis Z"));
}

}  // namespace remomask
