#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "remomask/error.h"
#include "rig/source_motion.h"
#include "scenes/gltf_reader.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::temporary_folder;

namespace {

/// A .gltf of three nodes whose buffer lies beside it.
class SmallGltf {
 public:
  SmallGltf() {
    json_ = {{"asset", {{"version", "2.0"}}},
             {"nodes",
              {{{"name", "top"}, {"children", {1}}, {"scale", {0.01, 0.01, 0.01}}},
               {{"name", "hips"}, {"children", {2}}, {"translation", {0, 100, 0}}},
               {{"name", "knee"}, {"translation", {0, -50, 0}}}}},
             {"animations", nlohmann::json::array()}};
  }

  int add(const std::vector<float>& values, const char* type, size_t width) {
    json_["bufferViews"].push_back({{"buffer", 0},
                                    {"byteOffset", bytes_.size()},
                                    {"byteLength", values.size() * sizeof(float)}});
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                  {"componentType", 5126},
                                  {"count", values.size() / width},
                                  {"type", type}});
    return static_cast<int>(json_["accessors"].size()) - 1;
  }

  void animate(const char* name, int node, const char* property, const char* how,
               const std::vector<float>& times, const std::vector<float>& values, size_t width) {
    const int input = add(times, "SCALAR", 1);
    const int output = add(values, width == 4 ? "VEC4" : "VEC3", width);
    json_["animations"].push_back(
        {{"name", name},
         {"samplers", {{{"input", input}, {"output", output}, {"interpolation", how}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", property}}}}}}});
  }

  nlohmann::json& json() { return json_; }

  std::string save() {
    const std::string folder = temporary_folder();
    json_["buffers"] = {{{"byteLength", bytes_.size()}, {"uri", "small%20keys.bin"}}};
    write_file_atomically(folder + "/small keys.bin", bytes_);
    write_file_atomically(folder + "/small.gltf", json_.dump());
    return folder + "/small.gltf";
  }

 private:
  nlohmann::json json_;
  std::string bytes_;
};

double knee_height(const rig::SourceMotion& motion, int frame) {
  return rig::world_positions(motion, frame)[2].y();
}

}  // namespace

TEST(GltfKeys, EveryInterpolationGivesItsCurve) {
  SmallGltf file;
  const std::vector<float> times = {0, 1, 2};
  file.animate("step", 1, "translation", "STEP", times, {0, 100, 0, 0, 200, 0, 0, 100, 0}, 3);
  file.animate("linear", 1, "translation", "LINEAR", times, {0, 100, 0, 0, 200, 0, 0, 100, 0}, 3);
  // Tangents of zero: eased between the same values.
  file.animate(
      "cubic", 1, "translation", "CUBICSPLINE", times,
      {0, 0, 0, 0, 100, 0, 0, 0, 0, 0, 0, 0, 0, 200, 0, 0, 0, 0, 0, 0, 0, 0, 100, 0, 0, 0, 0}, 3);
  const auto q = static_cast<float>(std::sqrt(0.5));
  file.animate("turn", 1, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, q, q}, 4);
  file.animate("growth", 1, "scale", "LINEAR", {0, 1}, {1, 1, 1, 2, 2, 2}, 3);
  const std::string path = file.save();
  const auto read = [&](const char* name) { return scenes::read_gltf(path, {name}); };
  // Sparse keys are sampled 30 times a second, and the scale of the top makes metres of it.
  EXPECT_EQ(read("step").frames, 61);
  EXPECT_DOUBLE_EQ(read("step").fps, 30);
  EXPECT_NEAR(knee_height(read("step"), 29), 0.5, 1e-6);
  EXPECT_NEAR(knee_height(read("step"), 30), 1.5, 1e-6);
  EXPECT_NEAR(knee_height(read("linear"), 15), 1.0, 1e-6);
  EXPECT_NEAR(knee_height(read("cubic"), 15), 1.0, 1e-6);
  EXPECT_NEAR(knee_height(read("cubic"), 6), 0.5 + 0.04 * (3 - 2 * 0.2), 1e-5);
  EXPECT_NEAR(knee_height(read("turn"), 30), 1.0, 1e-6);
  EXPECT_NEAR(rig::world_positions(read("turn"), 15)[2].x(), 0.5 * std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(knee_height(read("growth"), 30), 0.0, 1e-6);
  EXPECT_NEAR(knee_height(read("2"), 30), 1.5, 1e-6) << "by its number";
}

TEST(GltfKeys, AFrameOnAKeyShowsItsPose) {
  SmallGltf file;
  std::vector<float> times, values;
  for (int i = 0; i < 100; ++i) {
    times.push_back(static_cast<float>(i) / 20);
    values.insert(values.end(), {0, 100 + static_cast<float>(i), 0});
  }
  file.animate("step", 1, "translation", "STEP", times, values, 3);
  const rig::SourceMotion motion = scenes::read_gltf(file.save());
  ASSERT_EQ(motion.frames, 100);
  for (int t = 1; t < 100; ++t) {
    EXPECT_NEAR(knee_height(motion, t) - knee_height(motion, t - 1), 0.01, 1e-5) << t;
  }
}

TEST(GltfKeys, AnAnimationOfOtherNodesIsPassedOver) {
  SmallGltf file;
  file.animate("camera", 0, "translation", "STEP", {0, 1}, {0, 1, 0, 0, 1, 0}, 3);
  file.animate("walk", 1, "translation", "STEP", {0, 1}, {0, 100, 0, 0, 200, 0}, 3);
  file.json()["skins"] = {{{"joints", {1, 2}}}};
  std::vector<std::string> warnings;
  const rig::SourceMotion motion = scenes::read_gltf(file.save(), {}, &warnings);
  EXPECT_NEAR(knee_height(motion, motion.frames - 1) - knee_height(motion, 0), 1, 1e-6);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("\"walk\" is read"), std::string::npos) << warnings[0];
}

TEST(GltfKeys, TheFirstAnimationIsReadAndSaid) {
  SmallGltf file;
  file.animate("a", 1, "translation", "STEP", {0, 1}, {0, 1, 0, 0, 1, 0}, 3);
  file.animate("b", 1, "translation", "STEP", {0, 1}, {0, 1, 0, 0, 1, 0}, 3);
  file.json()["nodes"][0]["scale"] = {1, -1, 1};
  std::vector<std::string> warnings;
  scenes::read_gltf(file.save(), {}, &warnings);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_NE(warnings[0].find("scale"), std::string::npos);
  EXPECT_NE(warnings[1].find("2 animations"), std::string::npos);
  EXPECT_THROW(scenes::read_gltf(file.save(), {"c"}), FileError);
  EXPECT_THROW(scenes::read_gltf(file.save(), {"7"}), FileError);
}

TEST(GltfKeys, AFileWithoutAnimationSaysWhatItIsGoodFor) {
  SmallGltf file;
  file.add({0}, "SCALAR", 1);
  file.json()["skins"] = {{{"joints", {1, 2}}}};
  try {
    scenes::read_gltf(file.save());
    FAIL() << "no error";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("--character"), std::string::npos) << error.what();
  }
}

}  // namespace remomask
