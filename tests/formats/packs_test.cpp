// The importer on real files of every skeleton in the shared data.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "motion/vector.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "remomask/rotations.h"
#include "rig/forward_kinematics.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::largest_difference;
using testing_support::shared_data;
using testing_support::temporary_folder;

namespace {

/// Unpacks a pack (or some of its files) once; empty when the data is absent.
std::string unpack(const std::string& pack, const std::string& members = "") {
  const std::string archive = shared_data(pack + ".tar.xz");
  if (archive.empty()) return "";
  const std::string folder = temporary_folder() + "/" + pack;
  if (!std::filesystem::exists(folder)) {
    const std::string command =
        "tar -xJf '" + archive + "' -C '" + temporary_folder() + "' " + members;
    if (std::system(command.c_str()) != 0) return "";
  }
  return folder;
}

std::vector<nlohmann::json> lines_of(const std::string& pack) {
  std::vector<nlohmann::json> lines;
  std::ifstream file(shared_data(pack + ".jsonl"));
  for (std::string line; std::getline(file, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

/// Mean distance of the joints in metres when `b` starts `shift` frames later
/// and is turned and moved over the floor once as a whole to fit best.
double mean_distance(const Motion& a, const Motion& b, int shift) {
  const int first = std::max(0, -shift), last = std::min(a.frames, b.frames - shift);
  if (last - first < 10) return std::numeric_limits<double>::infinity();
  Vec3 centre_a = Vec3::Zero(), centre_b = Vec3::Zero();
  const double count = (last - first) * 22.0;
  for (int t = first; t < last; ++t) {
    for (int j = 0; j < 22; ++j) {
      centre_a += joint_position(a, t, j) / count;
      centre_b += joint_position(b, t + shift, j) / count;
    }
  }
  centre_a.y() = centre_b.y() = 0;
  double sine = 0, cosine = 0;
  for (int t = first; t < last; ++t) {
    for (int j = 0; j < 22; ++j) {
      const Vec3 p = joint_position(a, t, j) - centre_a,
                 q = joint_position(b, t + shift, j) - centre_b;
      cosine += p.x() * q.x() + p.z() * q.z();
      sine += p.x() * q.z() - p.z() * q.x();
    }
  }
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(std::atan2(sine, cosine), Vec3::UnitY()).toRotationMatrix();
  double sum = 0;
  for (int t = first; t < last; ++t) {
    for (int j = 0; j < 22; ++j) {
      sum +=
          (joint_position(a, t, j) - centre_a - turn * (joint_position(b, t + shift, j) - centre_b))
              .norm();
    }
  }
  return sum / count;
}

}  // namespace

class Packs : public ::testing::TestWithParam<const char*> {};

TEST_P(Packs, MapAxisUnitAndRateAgreeWithTheLabels) {
  const std::string pack = GetParam();
  const std::string folder = unpack(pack);
  if (folder.empty()) GTEST_SKIP() << "the shared data is not here";
  const auto sources = nlohmann::json::parse(std::ifstream(shared_data("skeleton_maps.json")));
  const std::string own = sources["source_skeleton"][pack];
  for (const nlohmann::json& line : lines_of(pack)) {
    const nlohmann::json& labels = line["labels"];
    const std::string name = line["clip"];
    const std::string path = folder + "/" + name + ".bvh";
    MotionFileOptions options;
    options.skip_frames = labels.value("skip_frames", 0);
    if (name == "importer_sinusoidal") {  // four joints, not a human
      EXPECT_THROW(load_motion(path), FileError);
      continue;
    }
    const LoadedMotion loaded = load_motion(path, options);
    EXPECT_EQ(loaded.skeleton_map,
              own == "labels.skeleton" ? labels["skeleton"].get<std::string>() : own)
        << name;
    EXPECT_EQ(loaded.up_axis, labels.value("up_axis", std::string("Y"))[0]) << name;
    EXPECT_NEAR(loaded.metres_per_unit / labels.value("metres_per_unit", 0.01), 1, 1e-6) << name;
    EXPECT_NEAR(loaded.source_fps, labels["fps"].get<double>(), 0.05) << name;
    EXPECT_EQ(loaded.source_frames, labels["frames"].get<int>()) << name;
    const double seconds = (loaded.source_frames - options.skip_frames - 1) / loaded.source_fps;
    EXPECT_NEAR(loaded.motion.frames, seconds * 20 + 1, 1) << name;

    const std::string copy = temporary_folder() + "/copy.bvh";
    save_motion(copy, loaded.motion);
    const Motion rigid = load_motion(copy).motion;
    save_motion(copy, rigid);
    EXPECT_LT(largest_difference(load_motion(copy).motion, rigid), 1e-3) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Real, Packs,
                         ::testing::Values("bandai1", "cmu_conv", "cmu_alt", "deepmimic", "misc"));

// What one rigid skeleton costs. The chests of three conversions (cmu_mobu, cmu_acclaim, m21) are
// 11 cm too low for any skeleton that fits the others, and are left out.
TEST(RigidSkeleton, MeetsTheJointsOfRealMotions) {
  std::array<double, 22> sums{};
  double frames = 0, steps = 0, slide_before = 0, slide_after = 0;
  for (const char* pack : {"bandai1", "cmu_conv", "deepmimic"}) {
    const std::string folder = unpack(pack);
    if (folder.empty()) GTEST_SKIP() << "the shared data is not here";
    for (const nlohmann::json& line : lines_of(pack)) {
      MotionFileOptions options;
      options.skip_frames = line["labels"].value("skip_frames", 0);
      const std::string name = line["clip"];
      const LoadedMotion loaded = load_motion(folder + "/" + name + ".bvh", options);
      if (loaded.skeleton_map == "cmu_mobu") continue;
      const Motion motion = slice(loaded.motion, 0, std::min(loaded.motion.frames, 100));
      const Motion rigid = rig::joint_positions(solve_rotations(motion));
      frames += motion.frames;
      for (int t = 0; t < motion.frames; ++t) {
        for (int j = 0; j < 22; ++j) {
          sums[static_cast<size_t>(j)] +=
              1000 * (joint_position(motion, t, j) - joint_position(rigid, t, j)).norm();
        }
        for (const int toe : {10, 11}) {
          if (t == 0 || motion.at(t, toe)[1] > 0.05f) continue;
          const Vec3 before = joint_position(motion, t, toe) - joint_position(motion, t - 1, toe);
          const Vec3 after = joint_position(rigid, t, toe) - joint_position(rigid, t - 1, toe);
          if (before.norm() > 0.01) continue;
          slide_before += before.norm();
          slide_after += after.norm();
          ++steps;
        }
      }
    }
  }
  double mean = 0;
  for (size_t j = 0; j < sums.size(); ++j) {
    EXPECT_LT(sums[j] / frames, 20) << humanml_skeleton().joint_names[j];
    mean += sums[j] / frames / 22;
  }
  EXPECT_LT(mean, 6);
  EXPECT_LT(slide_after / steps, slide_before / steps + 5e-5);
  RecordProperty("mean_mm", std::to_string(mean));
}

TEST(Retarget, TwoSkeletonsOfOneTrialAgree) {
  const std::string folder = unpack("cmu_alt");
  const std::string twins =
      unpack("cmu_daz",
             "cmu_daz/02_01.bvh cmu_daz/02_05.bvh cmu_daz/03_01.bvh cmu_daz/06_14.bvh "
             "cmu_daz/07_01.bvh");
  if (folder.empty() || twins.empty()) GTEST_SKIP() << "the shared data is not here";
  int pairs = 0;
  for (const nlohmann::json& line : lines_of("cmu_alt")) {
    if (!line["labels"].contains("duplicate_of")) continue;
    const std::string twin = line["labels"]["duplicate_of"];
    MotionFileOptions options;
    options.skip_frames = line["labels"]["skip_frames"];
    const std::string name = line["clip"];
    const Motion a = load_motion(folder + "/" + name + ".bvh", options).motion;
    double best = std::numeric_limits<double>::infinity();
    for (int skip = 8; skip < 14; ++skip) {  // six source frames make one at 20 fps
      options.skip_frames = skip;
      const Motion b = load_motion(twins + twin.substr(7) + ".bvh", options).motion;
      for (int shift = -5; shift <= 5; ++shift) {
        best = std::min(best, mean_distance(a, b, shift));
      }
    }
    EXPECT_LT(best, 0.06) << name;
    RecordProperty("trial_" + name, std::to_string(best));
    ++pairs;
  }
  EXPECT_EQ(pairs, 5);
}

}  // namespace remomask
