#include "scenes/gltf_character.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <optional>

#include "scenes/gltf_nodes.h"

namespace remomask::scenes {

namespace {

constexpr int kFloat = 5126;

/// Appends arrays of numbers to the first buffer of a file, and an animation that uses them.
class AnimationPatch {
 public:
  AnimationPatch(GltfDocument& document, std::string& bytes)
      : json_(document.json()), bytes_(bytes) {
    for (const char* list : {"accessors", "bufferViews"}) {
      if (!json_.contains(list)) json_[list] = nlohmann::json::array();
    }
  }

  int add(const std::vector<float>& values, size_t width, bool bounds = false) {
    static const char* const kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
    json_["bufferViews"].push_back({{"buffer", 0},
                                    {"byteOffset", bytes_.size()},
                                    {"byteLength", values.size() * sizeof(float)}});
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
    nlohmann::json accessor = {{"bufferView", json_["bufferViews"].size() - 1},
                               {"componentType", kFloat},
                               {"count", values.size() / width},
                               {"type", kTypes[width]}};
    if (bounds) {
      accessor["min"] = {values.front()};
      accessor["max"] = {values.back()};
    }
    json_["accessors"].push_back(std::move(accessor));
    return static_cast<int>(json_["accessors"].size()) - 1;
  }

  void channel(int node, const char* property, int times, int values) {
    samplers_.push_back({{"input", times}, {"output", values}, {"interpolation", "LINEAR"}});
    channels_.push_back(
        {{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", property}}}});
  }

  void finish(const std::string& name, const nlohmann::json& extras) {
    nlohmann::json animation = {{"name", name}, {"channels", channels_}, {"samplers", samplers_}};
    if (!extras.empty()) animation["extras"] = extras;
    json_["animations"] = nlohmann::json::array({std::move(animation)});
  }

 private:
  nlohmann::json& json_;
  std::string& bytes_;
  nlohmann::json channels_ = nlohmann::json::array(), samplers_ = nlohmann::json::array();
};

/// Files beside a .gltf would not come along.
void refuse_files_beside(const GltfDocument& document) {
  for (const char* list : {"images", "buffers"}) {
    for (size_t i = 0; i < document.list(list).size(); ++i) {
      const std::string uri = document.text(document.element(list, i), "uri");
      if (!uri.empty() && !uri.starts_with("data:")) {
        document.fail(
            fmt::format("{}[{}] lies in the file \"{}\" beside it and would be lost; "
                        "export the character as .glb",
                        list, i, uri));
      }
    }
  }
  const nlohmann::json& buffers = document.list("buffers");
  if (!buffers.empty() && buffers[0].contains("uri")) {
    document.fail("holds its buffer as text; export the character as .glb");
  }
}

std::string glb_of(const nlohmann::json& json, const std::string& binary) {
  std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string out("glTF");
  const auto number = [&](size_t value) {
    for (int i = 0; i < 4; ++i) out += static_cast<char>(value >> (8 * i) & 0xFF);
  };
  constexpr size_t kHeader = 12, kChunkHeader = 8, kVersion = 2;
  number(kVersion);
  number(kHeader + 2 * kChunkHeader + text.size() + binary.size());
  number(text.size());
  out += "JSON" + text;
  number(binary.size());
  out += std::string("BIN\0", 4) + binary;
  return out;
}

/// Values of one joint in all frames.
std::vector<float> joint_track(const std::vector<float>& all, size_t joints, size_t joint,
                               size_t width, int frames) {
  std::vector<float> values;
  for (size_t t = 0; t < static_cast<size_t>(frames); ++t) {
    const float* from = all.data() + (t * joints + joint) * width;
    values.insert(values.end(), from, from + width);
  }
  return values;
}

void keep_signs(std::vector<float>& turns) {
  for (size_t i = 4; i < turns.size(); i += 4) {
    float product = 0;
    for (size_t k = 0; k < 4; ++k) product += turns[i + k] * turns[i + k - 4];
    for (size_t k = 0; k < 4 && product < 0; ++k) turns[i + k] *= -1;
  }
}

/// How much nodes above a joint scale its translation; none if they do so unevenly.
double scale_above(const GltfNodes& nodes, int node) {
  double scale = 1;
  for (int at = nodes.parents[static_cast<size_t>(node)]; at >= 0;
       at = nodes.parents[static_cast<size_t>(at)]) {
    scale *= std::cbrt(std::abs(nodes.rest[static_cast<size_t>(at)].scale.prod()));
  }
  return scale > 1e-9 ? scale : 1;
}

}  // namespace

std::string character_glb(GltfDocument document, const GltfRig& rig, const std::string& name,
                          const nlohmann::json& extras) {
  refuse_files_beside(document);
  const GltfNodes nodes = read_gltf_nodes(document);
  const rig::SourceMotion& motion = rig.motion;
  const size_t joints = motion.joints.size();
  std::string bytes = document.binary();
  if (!document.json().contains("buffers") || document.list("buffers").empty()) {
    document.json()["buffers"] = nlohmann::json::array({{{"byteLength", 0}}});
    bytes.clear();
  }
  AnimationPatch patch(document, bytes);
  std::vector<float> clock;
  for (int t = 0; t < motion.frames; ++t) clock.push_back(static_cast<float>(t / motion.fps));
  const int times = patch.add(clock, 1, true);
  for (size_t j = 0; j < joints; ++j) {
    const int node = rig.nodes[j];
    // Animated nodes may have no matrix; one that moves is written as what it is made of.
    nlohmann::json& json = document.json()["nodes"][static_cast<size_t>(node)];
    const NodeTransform& rest = nodes.rest[static_cast<size_t>(node)];
    std::vector<float> turns = joint_track(motion.rotations, joints, j, 4, motion.frames);
    std::vector<float> places = joint_track(motion.translations, joints, j, 3, motion.frames);
    bool turns_differ = false, places_differ = false;
    for (int t = 0; t < motion.frames; ++t) {
      const float *q = turns.data() + t * 4, *p = places.data() + t * 3;
      turns_differ =
          turns_differ || Quat(q[3], q[0], q[1], q[2]).angularDistance(rest.rotation) > 1e-4;
      const Vec3& offset = motion.joints[j].offset;
      places_differ = places_differ || (Vec3(p[0], p[1], p[2]) - offset).norm() >
                                           1e-5 * std::max(1.0, offset.norm());
    }
    if ((turns_differ || places_differ) && json.contains("matrix")) {
      json.erase("matrix");
      json["translation"] = {rest.translation.x(), rest.translation.y(), rest.translation.z()};
      json["rotation"] = {rest.rotation.x(), rest.rotation.y(), rest.rotation.z(),
                          rest.rotation.w()};
      json["scale"] = {rest.scale.x(), rest.scale.y(), rest.scale.z()};
    }
    if (turns_differ) {
      keep_signs(turns);
      patch.channel(node, "rotation", times, patch.add(turns, 4));
    }
    if (places_differ) {
      const auto scale = static_cast<float>(scale_above(nodes, node));
      for (float& value : places) value /= scale;
      patch.channel(node, "translation", times, patch.add(places, 3));
    }
  }
  patch.finish(name, extras);
  bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
  document.json()["buffers"][0]["byteLength"] = bytes.size();
  return glb_of(document.json(), bytes);
}

}  // namespace remomask::scenes
