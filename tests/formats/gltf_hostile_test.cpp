#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "base/random.h"
#include "motion/canonical.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "scenes/fbx_reader.h"
#include "scenes/gltf_reader.h"
#include "scenes/uri.h"
#include "tests/motion/support.h"

namespace remomask {

using testing_support::make_walker;
using testing_support::temporary_folder;

namespace {

std::string hostile_path(const std::string& name) { return temporary_folder() + "/" + name; }

std::string sound_file(const std::string& extension) {
  const std::string path = hostile_path("sound" + extension);
  save_motion(path, motion::canonicalize(make_walker(5), humanml_skeleton()));
  return read_file(path);
}

std::string little(size_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
  return bytes;
}

/// A .glb with its JSON changed.
std::string changed(const std::string& glb, const std::function<void(nlohmann::json&)>& change) {
  uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, sizeof length);
  nlohmann::json json = nlohmann::json::parse(glb.substr(20, length));
  change(json);
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string rest = glb.substr(20 + length);
  return "glTF" + little(2) + little(20 + text.size() + rest.size()) + little(text.size()) +
         "JSON" + text + rest;
}

std::string gltf_refusal(const std::string& bytes, const std::string& name = "bad.glb") {
  write_file_atomically(hostile_path(name), bytes);
  try {
    scenes::read_gltf(hostile_path(name));
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(HostileGltf, WhatPointsNowhereIsRefused) {
  const std::string glb = sound_file(".glb");
  ASSERT_EQ(gltf_refusal(glb), "");
  const std::pair<const char*, std::function<void(nlohmann::json&)>> cases[] = {
      {"node of a channel",
       [](auto& j) { j["animations"][0]["channels"][0]["target"]["node"] = 999; }},
      {"sampler of a channel", [](auto& j) { j["animations"][0]["channels"][0]["sampler"] = -1; }},
      {"accessor of a sampler",
       [](auto& j) { j["animations"][0]["samplers"][0]["input"] = 4000000000U; }},
      {"view of an accessor",
       [](auto& j) {
         for (auto& accessor : j["accessors"]) accessor["bufferView"] = 5000;
       }},
      {"count",
       [](auto& j) {
         for (auto& a : j["accessors"]) a["count"] = 1U << 30;
       }},
      {"huge count",
       [](auto& j) {
         for (auto& a : j["accessors"]) a["count"] = 1ULL << 62;
       }},
      {"count without a view",
       [](auto& j) {
         for (auto& a : j["accessors"]) {
           a["count"] = 100'000'000;
           a.erase("bufferView");
         }
       }},
      {"offset",
       [](auto& j) {
         for (auto& v : j["bufferViews"]) v["byteOffset"] = 1U << 29;
       }},
      {"length",
       [](auto& j) {
         for (auto& v : j["bufferViews"]) v["byteLength"] = 1U << 29;
       }},
      {"stride",
       [](auto& j) {
         for (auto& v : j["bufferViews"]) v["byteStride"] = 1;
       }},
      {"buffer",
       [](auto& j) {
         for (auto& v : j["bufferViews"]) v["buffer"] = 3;
       }},
      {"buffer's length", [](auto& j) { j["buffers"][0]["byteLength"] = 1U << 29; }},
      {"child", [](auto& j) { j["nodes"][3]["children"] = {77777}; }},
      {"cycle", [](auto& j) { j["nodes"][4]["children"] = {0}; }},
      {"own child", [](auto& j) { j["nodes"][22]["children"] = {22}; }},
      {"two parents", [](auto& j) { j["nodes"][22]["children"] = {5}; }},
      {"joint", [](auto& j) { j["skins"][0]["joints"][0] = "Hips"; }},
      {"name",
       [](auto& j) {
         j["nodes"][0]["name"] = {1, 2};
       }},
      {"numbers",
       [](auto& j) {
         j["nodes"][1]["translation"] = {1, 2};
       }},
      {"infinite",
       [](auto& j) {
         j["nodes"][1]["translation"] = {1, 2, 1e300};
       }},
      {"no rotation",
       [](auto& j) {
         j["nodes"][1]["rotation"] = {0, 0, 0, 0};
       }},
      {"list", [](auto& j) { j["nodes"] = "many"; }},
      {"version", [](auto& j) { j["asset"]["version"] = "1.0"; }},
      {"file above", [](auto& j) { j["buffers"][0]["uri"] = "../../../etc/passwd"; }},
      {"absolute file", [](auto& j) { j["buffers"][0]["uri"] = "/etc/passwd"; }},
      {"hidden steps", [](auto& j) { j["buffers"][0]["uri"] = "%2e%2e/%2E%2E/etc/passwd"; }},
      {"net", [](auto& j) { j["buffers"][0]["uri"] = "http://127.0.0.1/x.bin"; }},
      {"scheme", [](auto& j) { j["buffers"][0]["uri"] = "file:///etc/passwd"; }},
      {"device", [](auto& j) { j["buffers"][0]["uri"] = "/dev/zero"; }},
      {"no base64", [](auto& j) { j["buffers"][0]["uri"] = "data:x;base64,!!!!"; }}};
  for (const auto& [what, change] : cases) {
    EXPECT_NE(gltf_refusal(changed(glb, change)), "") << what;
  }
}

TEST(HostileGltf, ImagesAreNeverOpened) {
  const std::string glb = changed(sound_file(".glb"), [](nlohmann::json& json) {
    json["images"] = {{{"uri", "/dev/zero"}}, {{"uri", "../secret.png"}}, {{"bufferView", 9999}}};
  });
  EXPECT_EQ(gltf_refusal(glb), "");
}

TEST(HostileGltf, DepthLengthAndTimeAreBounded) {
  const std::string glb = sound_file(".glb");
  EXPECT_NE(gltf_refusal("{\"asset\": {\"version\": \"2.0\", \"extras\": " +
                             std::string(500000, '[') + std::string(500000, ']') + "}}",
                         "deep.gltf"),
            "");
  EXPECT_NE(gltf_refusal("{\"asset\": " + std::string(500000, '['), "open.gltf"), "");
  EXPECT_NE(gltf_refusal(glb.substr(0, glb.size() / 2)), "");
  EXPECT_NE(gltf_refusal("glTF"), "");
  EXPECT_NE(gltf_refusal(""), "");
  // The last key a billion seconds later would be as many frames.
  std::string late = glb;
  const float times[] = {0.15F, 0.2F}, far[] = {0.15F, 1e9F};
  const size_t at = late.find(std::string(reinterpret_cast<const char*>(times), sizeof times));
  ASSERT_NE(at, std::string::npos);
  late.replace(at, sizeof far, reinterpret_cast<const char*>(far), sizeof far);
  EXPECT_NE(gltf_refusal(late), "");
  const float nothing[] = {0.15F, NAN};
  late.replace(at, sizeof nothing, reinterpret_cast<const char*>(nothing), sizeof nothing);
  EXPECT_NE(gltf_refusal(late), "");
}

TEST(HostileGltf, NamesOfFilesBesideIt) {
  EXPECT_TRUE(scenes::is_name_inside_folder("walk.bin"));
  EXPECT_TRUE(scenes::is_name_inside_folder("data/walk 1.bin"));
  for (const char* name : {"", "..", "../a", "a/../../b", "/a", "C:a", "a\\b", "http://x/a"}) {
    EXPECT_FALSE(scenes::is_name_inside_folder(name)) << name;
  }
  std::string bytes;
  EXPECT_TRUE(scenes::decode_data_uri("data:application/octet-stream;base64,AAEC", bytes));
  EXPECT_EQ(bytes, std::string("\0\1\2", 3));
  EXPECT_EQ(scenes::decode_percent("a%20b%"), "a b%");
}

/// Damaged bytes are an error or another motion, but nothing worse.
TEST(HostileFiles, DamagedBytesAreSurvived) {
  for (const char* extension : {".glb", ".fbx"}) {
    const std::string sound = sound_file(extension);
    CounterRandom random(5);
    for (int round = 0; round < 25; ++round) {
      std::string bytes = sound;
      // The first half of a file holds its structure.
      for (int k = 0; k < 4; ++k) {
        bytes[random.below(bytes.size() / 2)] = static_cast<char>(random.below(256));
      }
      const std::string path = hostile_path(std::string("damaged") + extension);
      write_file_atomically(path, bytes);
      try {
        extension == std::string(".glb") ? scenes::read_gltf(path) : scenes::read_fbx(path);
      } catch (const FileError&) {
      }
    }
  }
}

}  // namespace remomask
