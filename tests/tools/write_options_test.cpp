#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "formats/bvh.h"
#include "formats/npy.h"
#include "formats/npz.h"
#include "formats/skeleton_reading.h"
#include "motion/vector.h"
#include "remomask/motion_file.h"
#include "remomask/rotations.h"
#include "rig/forward_kinematics.h"
#include "rig/joint_names.h"
#include "scenes/fbx_reader.h"
#include "scenes/gltf_document.h"
#include "scenes/gltf_reader.h"
#include "synthetic/procedural.h"
#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

constexpr int kHips = 0, kHead = 15;

/// What a file is written with, and what it must hold.
struct WrittenCase {
  std::string extension;
  std::vector<std::string> options = {};
  double fps = 20;
  double metres_per_unit = 1;
};

std::string shown(const WrittenCase& written) {
  std::string text = written.extension;
  for (const std::string& option : written.options) text += " " + option;
  return text;
}

double lowest_point(const Motion& motion) {
  double lowest = INFINITY;
  for (size_t i = 1; i < motion.positions.size(); i += 3) {
    lowest = std::min(lowest, static_cast<double>(motion.positions[i]));
  }
  return lowest;
}

double largest_distance(const Motion& a, const Motion& b, int frames) {
  double largest = 0;
  for (int t = 0; t < frames; ++t) {
    for (int j = 0; j < 22; ++j) {
      largest = std::max(largest, (joint_position(a, t, j) - joint_position(b, t, j)).norm());
    }
  }
  return largest;
}

/// A walk around a corner, written by `remomask convert` and read back by our own readers.
class WriteOptionsTest : public testing::Test {
 protected:
  void SetUp() override {
    save_motion(source_, synthetic::make_procedural_clip("walk-turn-left").motion);
    expected_ =
        rig::joint_positions(solve_rotations(load_motion(source_).motion, {.keep_rigid = true}));
  }

  std::string convert(const WrittenCase& written) {
    const std::string path = scratch_ / ("out" + written.extension);
    std::vector<std::string> arguments = {"convert", source_, path, "--force"};
    arguments.insert(arguments.end(), written.options.begin(), written.options.end());
    answer_ = run_json(arguments);
    return path;
  }

  /// The joints as the file has them, at its own rate.
  static LoadedMotion read(const std::string& path) {
    MotionFileOptions as_it_is;
    as_it_is.canonical = false;
    return load_motion(path, as_it_is);
  }

  /// Writes a file and checks rate, unit, floor, height and every joint.
  void expect_same_motion(const WrittenCase& written) {
    SCOPED_TRACE(shown(written));
    const std::string path = convert(written);
    const LoadedMotion loaded = read(path);
    const double seconds = (expected_.frames - 1) / 20.0;
    const int frames = static_cast<int>(seconds * written.fps + 1e-3) + 1;
    EXPECT_EQ(answer_["file_fps"], written.fps);
    EXPECT_EQ(answer_["file_frames"], frames);
    EXPECT_EQ(loaded.source_frames, frames);
    EXPECT_NEAR(loaded.source_fps, written.fps, 0.01);
    EXPECT_EQ(loaded.metres_per_unit, written.metres_per_unit);
    EXPECT_EQ(loaded.up_axis, 'Y');
    EXPECT_NEAR(loaded.motion.frames, expected_.frames, 1);
    EXPECT_NEAR(lowest_point(loaded.motion), lowest_point(expected_), 0.005);
    // Between frames joints go straight or in arcs; on frames they are where they were.
    const bool on_frames = std::fmod(written.fps, 20) == 0;
    const int both = std::min(loaded.motion.frames, expected_.frames);
    EXPECT_LT(largest_distance(loaded.motion, expected_, both), on_frames ? 0.001 : 0.03);
  }

  /// The skeleton with rotations of a written .glb or .fbx.
  static rig::SourceMotion rig_of(const std::string& path) {
    return path.ends_with(".fbx") ? scenes::read_fbx(path) : scenes::read_gltf(path);
  }

  TestFolder scratch_;
  std::string source_ = scratch_ / "walk.npy";
  Motion expected_;
  nlohmann::json answer_;
};

const std::vector<std::string> kOfRotations = {".bvh", ".glb", ".vrma", ".fbx", ".npz"};

TEST_F(WriteOptionsTest, EveryFormatHoldsTheMotionAtEveryRate) {
  for (const std::string& extension : kOfRotations) {
    const double unit = extension == ".bvh" ? 0.01 : 1;
    for (const int fps : {20, 24, 25, 30, 50, 60, 120}) {
      expect_same_motion(
          {extension, {"--output-fps", std::to_string(fps)}, static_cast<double>(fps), unit});
    }
  }
}

TEST_F(WriteOptionsTest, EveryChoiceOfNamesIsInTheFileAndReadBack) {
  for (const rig::NamePreset& preset : rig::name_presets()) {
    for (const char* extension : {".bvh", ".glb", ".fbx"}) {
      const WrittenCase written = {extension,
                                   {"--names", std::string(preset.option)},
                                   20,
                                   extension == std::string(".bvh") ? 0.01 : 1};
      expect_same_motion(written);
      std::vector<std::string> warnings;
      const rig::SkeletonView skeleton =
          formats::read_skeleton(scratch_ / ("out" + written.extension), {}, warnings);
      for (const std::string_view joint : preset.joints) {
        EXPECT_GE(skeleton.find_joint(joint), 0) << shown(written) << ": " << joint;
      }
      if (written.extension != ".fbx") {
        EXPECT_GE(skeleton.find_joint(preset.root), 0) << shown(written);
      }
    }
  }
}

TEST_F(WriteOptionsTest, UnitsOfABvhAreThoseChosen) {
  for (const auto& [unit, scale] : {std::pair("cm", 100.0), std::pair("m", 1.0)}) {
    expect_same_motion({".bvh", {"--units", unit}, 20, 1 / scale});
    const formats::Bvh bvh = formats::read_bvh(scratch_ / "out.bvh");
    const double standing = bvh.joints[1].offset[1] / scale;  // of the hips in the T-pose
    EXPECT_GT(standing, 0.9) << unit;
    EXPECT_LT(standing, 1.0) << unit;
  }
}

TEST_F(WriteOptionsTest, InPlaceKeepsHeightsAndPoses) {
  for (const std::string& extension : kOfRotations) {
    SCOPED_TRACE(extension);
    const Motion motion = read(convert({extension, {"--in-place"}})).motion;
    ASSERT_EQ(motion.frames, expected_.frames);
    for (int t = 0; t < motion.frames; ++t) {
      const Vec3 hips = joint_position(motion, t, kHips), was = joint_position(expected_, t, kHips);
      EXPECT_NEAR(std::hypot(hips.x(), hips.z()), 0, 1e-4) << t;
      EXPECT_NEAR(hips.y(), was.y(), 1e-3) << t;
      const Vec3 head = joint_position(motion, t, kHead) - hips;
      EXPECT_LT((head - (joint_position(expected_, t, kHead) - was)).norm(), 1e-3) << t;
    }
  }
}

TEST_F(WriteOptionsTest, ALoopEndsInThePoseOfItsFirstFrame) {
  for (const std::string& extension : kOfRotations) {
    SCOPED_TRACE(extension);
    const Motion motion = read(convert({extension, {"--loop"}})).motion;
    EXPECT_TRUE(answer_["loop"]["travels"].get<bool>());
    ASSERT_EQ(motion.frames, expected_.frames);
    // Bones do not change, so equal distances of all joints are an equal pose wherever it stands.
    const int last = motion.frames - 1;
    for (int j = 1; j < 22; ++j) {
      const auto from_hips = [&](int frame) {
        return (joint_position(motion, frame, j) - joint_position(motion, frame, kHips)).norm();
      };
      EXPECT_NEAR(from_hips(0), from_hips(last), 0.001) << j;
    }
    EXPECT_NEAR(joint_position(motion, 0, kHips).y(), joint_position(motion, last, kHips).y(),
                1e-3);
    EXPECT_LT(largest_distance(motion, expected_, last - 20), 0.001) << "before the last second";
  }
}

TEST_F(WriteOptionsTest, RootMotionPutsTheHeadingOnTheRoot) {
  for (const char* extension : {".glb", ".fbx"}) {
    for (const bool chosen : {false, true}) {
      SCOPED_TRACE(extension);
      const std::vector<std::string> options =
          chosen ? std::vector<std::string>{"--root-motion"} : std::vector<std::string>{};
      expect_same_motion({extension, options});
      const rig::SourceMotion motion = rig_of(scratch_ / ("out" + std::string(extension)));
      const int root = motion.find_joint("Root");
      if (root < 0) {
        EXPECT_FALSE(chosen);
        continue;
      }
      const float* last = motion.rotations.data() +
                          4 * ((static_cast<size_t>(motion.frames) - 1) * motion.joints.size() +
                               static_cast<size_t>(root));
      const double heading = 2 * std::atan2(std::abs(last[1]), std::abs(last[3]));
      if (chosen) {
        EXPECT_GT(heading, 0.5);
      } else {
        EXPECT_LT(heading, 1e-3);
      }
    }
  }
}

TEST_F(WriteOptionsTest, ProportionsAreThePerformersOrTheCommonOnes) {
  Motion small = synthetic::make_procedural_clip("walk-forward").motion;
  for (float& value : small.positions) value *= 0.8f;
  save_motion(source_, small);
  const auto thigh = [](const Motion& motion) {
    return (joint_position(motion, 0, 1) - joint_position(motion, 0, 4)).norm();
  };
  const double ours = humanml_skeleton().bone_lengths[4];
  for (const std::string& extension : kOfRotations) {
    SCOPED_TRACE(extension);
    EXPECT_NEAR(thigh(read(convert({extension})).motion), ours, 1e-3);
    EXPECT_NEAR(thigh(read(convert({extension, {"--own-proportions"}})).motion), 0.8 * ours, 2e-3);
  }
}

TEST_F(WriteOptionsTest, TheCommonSkeletonIsTheSameInEveryFile) {
  const auto rest = [&](const std::vector<std::string>& options) {
    std::vector<std::string> warnings;
    const std::string path = convert({".bvh", options});
    return formats::read_skeleton(path, {}, warnings).rest.positions;
  };
  const std::vector<Vec3> first = rest({"--common-skeleton"});
  save_motion(source_, synthetic::make_procedural_clip("jump-forward").motion);
  const std::vector<Vec3> second = rest({"--common-skeleton"});
  ASSERT_EQ(first.size(), second.size());
  for (size_t j = 0; j < first.size(); ++j) EXPECT_LT((first[j] - second[j]).norm(), 1e-3) << j;
}

TEST_F(WriteOptionsTest, ArraysHoldPositionsPosesOrFeatures) {
  const Motion source = load_motion(source_).motion;
  EXPECT_LT(largest_distance(read(convert({".npy"})).motion, source, source.frames), 1e-6);
  const formats::NpyArray fast = formats::read_npy(convert({".npy", {"--output-fps", "60"}}));
  EXPECT_EQ(fast.shape, (std::vector<size_t>{static_cast<size_t>(3 * source.frames - 2), 22, 3}));

  const std::string features = convert({".npy", {"--features"}});
  EXPECT_EQ(formats::read_npy(features).shape[1], 263u);
  const Motion recovered = read(features).motion;
  EXPECT_LT(largest_distance(recovered, source, recovered.frames), 0.01);

  const std::string amass = convert({".npz", {"--npz", "amass"}});
  const formats::NpzArrays arrays =
      formats::read_npz(amass, {"poses", "trans", "mocap_framerate", "mocap_frame_rate"});
  EXPECT_EQ(arrays.find("poses")->shape[1], 156u);
  EXPECT_EQ(arrays.find("mocap_frame_rate")->values[0], 20);
  // The T-pose of SMPL is another than ours: the same motion, not the same joints.
  const LoadedMotion read_back = load_motion(amass);
  EXPECT_EQ(read_back.up_axis, 'Z');
  ASSERT_EQ(read_back.motion.frames, source.frames);
  for (const int t : {0, source.frames - 1}) {
    EXPECT_LT(
        (joint_position(read_back.motion, t, kHips) - joint_position(source, t, kHips)).norm(), 0.1)
        << t;
  }
}

TEST_F(WriteOptionsTest, SeveralClipsGoIntoOneFile) {
  const std::string database = scratch_ / "some.sqlite";
  run_json({"procedural", "--db", database, "--count", "3"});
  const auto clips = run_json({"db", "list", database})["clips"];
  for (const char* extension : {".glb", ".fbx"}) {
    const std::string path = scratch_ / ("all" + std::string(extension));
    EXPECT_EQ(run_json({"db", "export", database, path, "--one-file"})["clips"], 3);
    for (const auto& clip : clips) {
      MotionFileOptions reading;
      reading.animation = clip["name"];
      EXPECT_EQ(load_motion(path, reading).motion.frames, clip["frames"]) << path;
    }
  }
  const scenes::GltfDocument document(scratch_ / "all.glb");
  const auto& about = document.json()["animations"][0]["extras"]["remomask"];
  EXPECT_EQ(about["licence"], "MIT");
  EXPECT_FALSE(about["captions"].empty());
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{scratch_ / "all.bvh", "--one-file"},
        {scratch_ / "all.glb", "--one-file", "--format", "glb"},
        {scratch_ / "all.glb", "--one-file", "--character", scratch_ / "all.glb"}}) {
    std::vector<std::string> arguments = {"db", "export", database};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    EXPECT_NE(run_program(arguments).exit_code, 0) << wrong.back();
  }
}

TEST_F(WriteOptionsTest, LengthsOfFilesAreInAnyUnit) {
  // An .npy file and a BVH state no unit: it is found by the length of the legs.
  const Motion source = load_motion(source_).motion;
  for (const double unit : {1.0, 0.1, 0.01, 0.001, 0.0254}) {
    Motion scaled = source;
    for (float& value : scaled.positions) value = static_cast<float>(value / unit);
    const std::string path = scratch_ / "scaled.npy";
    save_motion(path, scaled);
    const LoadedMotion loaded = load_motion(path);
    EXPECT_EQ(loaded.metres_per_unit, unit);
    EXPECT_LT(largest_distance(loaded.motion, source, source.frames), 1e-3) << unit;
  }
}

}  // namespace
}  // namespace remomask
