#include "scenes/gltf_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "remomask/error.h"
#include "scenes/gltf_animation.h"
#include "scenes/gltf_nodes.h"

namespace remomask::scenes {

namespace {

struct Bind {
  int node = 0;
  NodeTransform world;
};

/// Joints of all skins with the transforms in which they were bound to the mesh.
std::vector<Bind> read_binds(const GltfDocument& document) {
  std::vector<Bind> binds;
  for (size_t s = 0; s < document.list("skins").size(); ++s) {
    const nlohmann::json& skin = document.element("skins", s);
    const auto joints = skin.find("joints");
    if (joints == skin.end() || !joints->is_array()) {
      document.fail(fmt::format("skins[{}] has no joints", s));
    }
    const int accessor = document.index(skin, "inverseBindMatrices", "accessors");
    GltfNumbers matrices;
    if (accessor >= 0) matrices = document.accessor(accessor);
    if (accessor >= 0 && (matrices.width != 16 || matrices.count < joints->size())) {
      document.fail(fmt::format("skins[{}] lacks inverse bind matrices", s));
    }
    for (size_t j = 0; j < joints->size(); ++j) {
      const nlohmann::json& node = (*joints)[j];
      if (!node.is_number_unsigned() || node.get<uint64_t>() >= document.list("nodes").size()) {
        document.fail(fmt::format("skins[{}].joints names a node that does not exist", s));
      }
      Bind bind;
      bind.node = static_cast<int>(node.get<uint64_t>());
      if (accessor >= 0) {
        const Eigen::Matrix4d inverse =
            Eigen::Map<const Eigen::Matrix4f>(matrices.at(j)).cast<double>();
        if (std::abs(inverse.determinant()) < 1e-18) {
          document.fail(fmt::format("skins[{}] has an inverse bind matrix without inverse", s));
        }
        const Eigen::Matrix4d world = inverse.inverse();
        bind.world = split_matrix(world.data());
      }
      binds.push_back(bind);
    }
  }
  return binds;
}

/// Which nodes become joints, parents first.
std::vector<int> choose_nodes(const GltfDocument& document, const GltfNodes& nodes,
                              const std::vector<Bind>& binds,
                              const std::optional<NodeTimeline>& timeline) {
  std::vector<bool> chosen(nodes.parents.size(), false);
  for (const Bind& bind : binds) chosen[static_cast<size_t>(bind.node)] = true;
  if (binds.empty() && timeline) {
    for (const NodeTrack& track : timeline->tracks) chosen[static_cast<size_t>(track.node)] = true;
    // What hangs from an animated node may be the end of a bone, unless it is a thing to see.
    for (const int node : nodes.order) {
      const int parent = nodes.parents[static_cast<size_t>(node)];
      const nlohmann::json& json = document.element("nodes", static_cast<size_t>(node));
      const bool thing = json.contains("mesh") || json.contains("camera");
      if (parent >= 0 && chosen[static_cast<size_t>(parent)] && !thing) {
        chosen[static_cast<size_t>(node)] = true;
      }
    }
  }
  for (size_t i = nodes.order.size(); i-- > 0;) {
    const auto node = static_cast<size_t>(nodes.order[i]);
    if (chosen[node] && nodes.parents[node] >= 0) {
      chosen[static_cast<size_t>(nodes.parents[node])] = true;
    }
  }
  std::vector<int> result;
  for (const int node : nodes.order) {
    if (chosen[static_cast<size_t>(node)]) result.push_back(node);
  }
  return result;
}

/// A file that was saved in the middle of a movement says in its skin how it stood when it was
/// bound; rest poses are taken from there where the two differ.
void rest_from_binds(GltfRig& result, const std::vector<Bind>& binds,
                     std::vector<NodeTransform>& rest) {
  std::vector<const NodeTransform*> bound(result.nodes.size(), nullptr);
  for (const Bind& bind : binds) {
    const auto at = std::find(result.nodes.begin(), result.nodes.end(), bind.node);
    bound[static_cast<size_t>(at - result.nodes.begin())] = &bind.world;
  }
  const auto relative = [&](size_t j) -> std::optional<Quat> {
    const int parent = result.motion.joints[j].parent;
    if (parent < 0 || !bound[j] || !bound[static_cast<size_t>(parent)]) return {};
    return bound[static_cast<size_t>(parent)]->rotation.conjugate() * bound[j]->rotation;
  };
  bool posed = false;
  constexpr double kDifferent = 0.05;  // radians
  for (size_t j = 0; j < bound.size(); ++j) {
    const std::optional<Quat> turn = relative(j);
    posed = posed || (turn && turn->angularDistance(rest[j].rotation) > kDifferent);
  }
  if (!posed) return;
  for (size_t j = 0; j < bound.size(); ++j) {
    if (const std::optional<Quat> turn = relative(j)) rest[j].rotation = *turn;
  }
  result.warnings.push_back(
      "the nodes stand in another pose than the skin was bound in; the "
      "latter is taken as the rest pose");
}

void warn_of_scales(GltfRig& result, const std::vector<NodeTransform>& rest) {
  for (size_t j = 0; j < rest.size(); ++j) {
    const Vec3& scale = rest[j].scale;
    const double widest = scale.cwiseAbs().maxCoeff();
    if (scale.minCoeff() < 0 || widest - scale.cwiseAbs().minCoeff() > 0.01 * widest) {
      result.warnings.push_back(fmt::format(
          "\"{}\" has a scale of {:g} {:g} {:g}; joints stay where they are, turns ignore it",
          result.motion.joints[j].name, scale.x(), scale.y(), scale.z()));
      return;
    }
  }
}

/// glTF is in metres; files that are not are left to the detection by size.
void state_units(rig::SourceMotion& motion) {
  motion.up_axis = 'Y';
  double low = INFINITY, high = -INFINITY;
  for (const Vec3& place : rig::world_positions(motion, -1)) {
    low = std::min(low, place.y());
    high = std::max(high, place.y());
  }
  constexpr double kSmallest = 0.5, kTallest = 3;
  if (high - low > kSmallest && high - low < kTallest) motion.metres_per_unit = 1;
}

}  // namespace

GltfRig read_gltf_rig(const GltfDocument& document, const AnimationChoice& choice) {
  const GltfNodes nodes = read_gltf_nodes(document);
  const std::vector<Bind> binds = read_binds(document);
  const std::optional<NodeTimeline> timeline = read_gltf_timeline(document, choice.animation);
  GltfRig result;
  result.nodes = choose_nodes(document, nodes, binds, timeline);
  if (result.nodes.empty()) {
    document.fail("has no skeleton: neither a skin nor an animated node; export it with armature");
  }
  std::vector<int> joint_of(nodes.parents.size(), -1);
  std::vector<NodeTransform> rest;
  for (const int node : result.nodes) {
    const auto at = static_cast<size_t>(node);
    rig::SourceJoint joint;
    joint.name = document.text(document.element("nodes", at), "name");
    if (joint.name.empty()) joint.name = fmt::format("node{}", node);
    joint.parent = nodes.parents[at] < 0 ? -1 : joint_of[static_cast<size_t>(nodes.parents[at])];
    joint_of[at] = static_cast<int>(result.motion.joints.size());
    result.motion.joints.push_back(std::move(joint));
    rest.push_back(nodes.rest[at]);
  }
  warn_of_scales(result, rest);
  std::vector<NodeTransform> bound = rest;
  rest_from_binds(result, binds, bound);
  set_rest(bound, result.motion);
  state_units(result.motion);
  const size_t animations = document.list("animations").size();
  if (animations > 1 && choice.animation.empty()) {
    result.warnings.push_back(
        fmt::format("holds {} animations; \"{}\" is read", animations, timeline->name));
  }
  if (timeline && !timeline->tracks.empty()) {
    try {
      add_frames(*timeline, joint_of, rest, result.motion);
    } catch (const Error& error) {
      document.fail(error.what());
    }
  }
  return result;
}

rig::SourceMotion read_gltf(const std::string& path, const AnimationChoice& choice,
                            std::vector<std::string>* warnings) {
  GltfRig result = read_gltf_rig(GltfDocument(path), choice);
  if (result.motion.frames == 0) {
    throw FileError(path, 0,
                    "has no animation of its skeleton; a character without motion goes into "
                    "`remomask retarget --character`");
  }
  if (warnings) warnings->insert(warnings->end(), result.warnings.begin(), result.warnings.end());
  return std::move(result.motion);
}

}  // namespace remomask::scenes
