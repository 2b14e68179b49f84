#include "scenes/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace remomask::scenes {

namespace {

std::vector<std::string> animation_names(const GltfDocument& document) {
  std::vector<std::string> names;
  for (size_t i = 0; i < document.list("animations").size(); ++i) {
    names.push_back(document.text(document.element("animations", i), "name"));
  }
  return names;
}

/// Numbers of the nodes that skins name; what is wrong with a skin is said by whoever reads it.
std::set<uint64_t> skin_joints(const GltfDocument& document) {
  std::set<uint64_t> nodes;
  for (size_t s = 0; s < document.list("skins").size(); ++s) {
    const nlohmann::json joints = document.element("skins", s).value("joints", nlohmann::json());
    for (const nlohmann::json& node : joints) {
      if (node.is_number_unsigned()) nodes.insert(node.get<uint64_t>());
    }
  }
  return nodes;
}

/// Cameras and props have animations of their own, which may come first.
size_t first_animation_of_joints(const GltfDocument& document) {
  const std::set<uint64_t> joints = skin_joints(document);
  for (size_t i = 0; i < document.list("animations").size(); ++i) {
    const nlohmann::json& animation = document.element("animations", i);
    const auto channels = animation.find("channels");
    if (channels == animation.end() || !channels->is_array()) continue;
    for (const nlohmann::json& channel : *channels) {
      const auto target = channel.is_object() ? channel.find("target") : channel.end();
      if (target == channel.end() || !target->is_object()) continue;
      const auto node = target->find("node");
      if (node == target->end() || !node->is_number_unsigned()) continue;
      if (joints.empty() || joints.contains(node->get<uint64_t>())) return i;
    }
  }
  return 0;
}

size_t choose_animation(const GltfDocument& document, const std::string& wanted) {
  const std::vector<std::string> names = animation_names(document);
  if (wanted.empty()) return first_animation_of_joints(document);
  const auto named = std::find(names.begin(), names.end(), wanted);
  if (named != names.end()) return static_cast<size_t>(named - names.begin());
  const bool digits = wanted.size() < 7 && std::all_of(wanted.begin(), wanted.end(),
                                                       [](char c) { return c >= '0' && c <= '9'; });
  if (digits && std::stoul(wanted) < names.size()) return std::stoul(wanted);
  constexpr size_t kShown = 20;
  std::string known;
  for (size_t i = 0; i < std::min(kShown, names.size()); ++i) {
    known += fmt::format("{}{} \"{}\"", i ? ", " : "", i, names[i]);
  }
  document.fail(fmt::format("has no animation \"{}\"; it has {}", wanted, known));
}

std::vector<float> read_times(const GltfDocument& document, int accessor) {
  GltfNumbers input = document.accessor(accessor);
  if (input.width != 1) document.fail("an animation's times are not scalars");
  for (size_t i = 0; i < input.count; ++i) {
    if (input.values[i] < 0 || (i > 0 && input.values[i] < input.values[i - 1])) {
      document.fail(fmt::format("the times of accessors[{}] do not increase", accessor));
    }
  }
  return std::move(input.values);
}

NodeTrack read_track(const GltfDocument& document, const nlohmann::json& sampler, int node,
                     NodeTrack::Property property) {
  NodeTrack track;
  track.node = node;
  track.property = property;
  const std::string how = document.text(sampler, "interpolation");
  if (how == "STEP") {
    track.interpolation = NodeTrack::Interpolation::step;
  } else if (how == "CUBICSPLINE") {
    track.interpolation = NodeTrack::Interpolation::cubic_spline;
  } else if (!how.empty() && how != "LINEAR") {
    document.fail("an animation's interpolation \"" + how + "\" is unknown");
  }
  const int input = document.index(sampler, "input", "accessors");
  const int output = document.index(sampler, "output", "accessors");
  if (input < 0 || output < 0) document.fail("an animation's sampler lacks its input or output");
  track.times = read_times(document, input);
  GltfNumbers values = document.accessor(output);
  const size_t width = property == NodeTrack::Property::rotation ? 4 : 3;
  const size_t per_key = track.interpolation == NodeTrack::Interpolation::cubic_spline ? 3 : 1;
  if (values.width != width || values.count != track.times.size() * per_key) {
    document.fail(fmt::format("accessors[{}] does not hold a value for every key", output));
  }
  track.values = std::move(values.values);
  return track;
}

/// A channel of a joint; nothing for weights and for channels without a node.
std::optional<NodeTrack> read_channel(const GltfDocument& document, const nlohmann::json& channel,
                                      const nlohmann::json& samplers) {
  const auto target = channel.is_object() ? channel.find("target") : channel.end();
  if (!channel.is_object() || target == channel.end() || !target->is_object()) {
    document.fail("an animation's channel has no target");
  }
  const int node = document.index(*target, "node", "nodes");
  const std::string path = document.text(*target, "path");
  NodeTrack::Property property = NodeTrack::Property::translation;
  if (path == "rotation") {
    property = NodeTrack::Property::rotation;
  } else if (path == "scale") {
    property = NodeTrack::Property::scale;
  } else if (path != "translation") {
    return {};
  }
  if (node < 0) return {};
  const auto number = channel.find("sampler");
  if (number == channel.end() || !number->is_number_unsigned() ||
      number->get<uint64_t>() >= samplers.size() ||
      !samplers[number->get<uint64_t>()].is_object()) {
    document.fail("an animation's channel names a sampler that does not exist");
  }
  return read_track(document, samplers[number->get<uint64_t>()], node, property);
}

}  // namespace

std::optional<NodeTimeline> read_gltf_timeline(const GltfDocument& document,
                                               const std::string& wanted) {
  if (document.list("animations").empty()) return {};
  const nlohmann::json& animation =
      document.element("animations", choose_animation(document, wanted));
  const auto channels = animation.find("channels"), samplers = animation.find("samplers");
  if (channels == animation.end() || samplers == animation.end() || !channels->is_array() ||
      !samplers->is_array()) {
    document.fail("an animation lacks channels or samplers");
  }
  NodeTimeline timeline;
  timeline.name = document.text(animation, "name");
  bool any = false;
  size_t numbers = 0;
  for (const nlohmann::json& channel : *channels) {
    std::optional<NodeTrack> track = read_channel(document, channel, *samplers);
    if (!track) continue;
    // Many channels may name one long sampler; what they hold together is bounded as well.
    constexpr size_t kMaxAnimationNumbers = 400'000'000;
    numbers += track->values.size() + track->times.size();
    if (numbers > kMaxAnimationNumbers) document.fail("has an animation of too many keys");
    timeline.begin = any ? std::min<double>(timeline.begin, track->times.front())
                         : static_cast<double>(track->times.front());
    timeline.end = std::max<double>(timeline.end, track->times.back());
    any = true;
    timeline.tracks.push_back(std::move(*track));
  }
  return timeline;
}

}  // namespace remomask::scenes
