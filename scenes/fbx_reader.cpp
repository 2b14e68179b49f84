#include "scenes/fbx_reader.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <filesystem>

#include "base/file.h"
#include "remomask/error.h"
#include "scenes/node_motion.h"

namespace remomask::scenes {

namespace {

constexpr uint64_t kLargestFbx = 512ULL << 20;
constexpr size_t kMaxFbxNodes = 100'000;

Vec3 vec_of(const aiVector3D& v) { return {v.x, v.y, v.z}; }
Quat quat_of(const aiQuaternion& q) { return {q.w, q.x, q.y, q.z}; }

/// The nodes of a scene, parents first.
struct SceneNodes {
  std::vector<const aiNode*> nodes;
  std::vector<int> parents;

  int find(const aiString& name) const {
    for (size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i]->mName == name) return static_cast<int>(i);
    }
    return -1;
  }
};

SceneNodes list_nodes(const aiScene& scene, const std::string& path) {
  SceneNodes result;
  std::vector<std::pair<const aiNode*, int>> waiting = {{scene.mRootNode, -1}};
  while (!waiting.empty()) {
    const auto [node, parent] = waiting.back();
    waiting.pop_back();
    const int at = static_cast<int>(result.nodes.size());
    if (result.nodes.size() > kMaxFbxNodes) throw FileError(path, 0, "has too many nodes");
    result.nodes.push_back(node);
    result.parents.push_back(parent);
    for (unsigned c = node->mNumChildren; c-- > 0;) waiting.emplace_back(node->mChildren[c], at);
  }
  return result;
}

const aiAnimation* choose_scene_animation(const aiScene& scene, const std::string& wanted,
                                          const std::string& path) {
  if (scene.mNumAnimations == 0) return nullptr;
  if (wanted.empty()) return scene.mAnimations[0];
  std::string known;
  for (unsigned a = 0; a < scene.mNumAnimations; ++a) {
    const std::string name = scene.mAnimations[a]->mName.C_Str();
    if (name == wanted || std::to_string(a) == wanted) return scene.mAnimations[a];
    if (a < 20) known += fmt::format("{}{} \"{}\"", a ? ", " : "", a, name);
  }
  throw FileError(path, 0, fmt::format("has no animation \"{}\"; it has {}", wanted, known));
}

template <typename Key, typename Write>
void add_track(NodeTimeline& timeline, int node, NodeTrack::Property property, const Key* keys,
               unsigned count, double ticks, Write write) {
  if (count == 0) return;
  NodeTrack track;
  track.node = node;
  track.property = property;
  for (unsigned i = 0; i < count; ++i) {
    const auto time = static_cast<float>(keys[i].mTime / ticks);
    if (!std::isfinite(time) || (i > 0 && time < track.times.back())) {
      throw Error("has keys whose times do not increase");
    }
    track.times.push_back(time);
    write(keys[i].mValue, track.values);
  }
  for (const float value : track.values) {
    if (!std::isfinite(value)) throw Error("has a key that is not finite");
  }
  const bool first = timeline.tracks.empty();
  timeline.begin =
      first ? track.times.front() : std::min<double>(timeline.begin, track.times.front());
  timeline.end = first ? track.times.back() : std::max<double>(timeline.end, track.times.back());
  timeline.tracks.push_back(std::move(track));
}

NodeTimeline timeline_of(const aiAnimation& animation, const SceneNodes& nodes) {
  NodeTimeline timeline;
  timeline.name = animation.mName.C_Str();
  constexpr double kAssimpDefault = 25;
  const double ticks = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : kAssimpDefault;
  const auto three = [](const aiVector3D& v, std::vector<float>& out) {
    out.insert(out.end(), {v.x, v.y, v.z});
  };
  const auto four = [](const aiQuaternion& q, std::vector<float>& out) {
    out.insert(out.end(), {q.x, q.y, q.z, q.w});
  };
  for (unsigned c = 0; c < animation.mNumChannels; ++c) {
    const aiNodeAnim& track = *animation.mChannels[c];
    const int node = nodes.find(track.mNodeName);
    if (node < 0) continue;
    using Property = NodeTrack::Property;
    add_track(timeline, node, Property::translation, track.mPositionKeys, track.mNumPositionKeys,
              ticks, three);
    add_track(timeline, node, Property::rotation, track.mRotationKeys, track.mNumRotationKeys,
              ticks, four);
    add_track(timeline, node, Property::scale, track.mScalingKeys, track.mNumScalingKeys, ticks,
              three);
  }
  return timeline;
}

std::vector<bool> choose_scene_nodes(const aiScene& scene, const SceneNodes& nodes,
                                     const NodeTimeline& timeline) {
  std::vector<bool> chosen(nodes.nodes.size(), false);
  bool skinned = false;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    for (unsigned b = 0; b < scene.mMeshes[m]->mNumBones; ++b) {
      const int node = nodes.find(scene.mMeshes[m]->mBones[b]->mName);
      if (node >= 0) skinned = chosen[static_cast<size_t>(node)] = true;
    }
  }
  for (const NodeTrack& track : timeline.tracks) chosen[static_cast<size_t>(track.node)] = true;
  for (size_t i = 1; i < chosen.size() && !skinned; ++i) {
    // The ends of bones hang from animated nodes.
    const bool below = chosen[static_cast<size_t>(nodes.parents[i])];
    if (below && nodes.nodes[i]->mNumMeshes == 0) chosen[i] = true;
  }
  for (size_t i = chosen.size(); i-- > 1;) {
    if (chosen[i]) chosen[static_cast<size_t>(nodes.parents[i])] = true;
  }
  return chosen;
}

/// FBX states centimetres per unit; files whose body would then be no human's are left to the
/// detection by size.
void state_fbx_units(const aiScene& scene, rig::SourceMotion& motion) {
  float centimetres = 0;
  double whole = 0;
  if (!scene.mMetaData || (!scene.mMetaData->Get("UnitScaleFactor", centimetres) &&
                           !scene.mMetaData->Get("UnitScaleFactor", whole))) {
    return;
  }
  const double metres = (centimetres > 0 ? centimetres : whole) / 100;
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  for (const Vec3& place : rig::world_positions(motion, -1)) {
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
  }
  const double size = (high - low).maxCoeff() * metres;
  constexpr double kSmallest = 0.5, kTallest = 4;
  if (size > kSmallest && size < kTallest) motion.metres_per_unit = metres;
}

rig::SourceMotion motion_of_scene(const aiScene& scene, const AnimationChoice& choice,
                                  const std::string& path, std::vector<std::string>* warnings) {
  const SceneNodes nodes = list_nodes(scene, path);
  NodeTimeline timeline;
  if (const aiAnimation* chosen = choose_scene_animation(scene, choice.animation, path)) {
    timeline = timeline_of(*chosen, nodes);
  }
  if (scene.mNumAnimations > 1 && choice.animation.empty() && warnings) {
    warnings->push_back(fmt::format("holds {} animations; the first, \"{}\", is read",
                                    scene.mNumAnimations, timeline.name));
  }
  const std::vector<bool> chosen = choose_scene_nodes(scene, nodes, timeline);
  rig::SourceMotion motion;
  std::vector<int> joint_of(nodes.nodes.size(), -1);
  std::vector<NodeTransform> rest;
  for (size_t i = 0; i < chosen.size(); ++i) {
    if (!chosen[i]) continue;
    rig::SourceJoint joint;
    joint.name = nodes.nodes[i]->mName.C_Str();
    joint.parent = nodes.parents[i] < 0 ? -1 : joint_of[static_cast<size_t>(nodes.parents[i])];
    joint_of[i] = static_cast<int>(motion.joints.size());
    motion.joints.push_back(std::move(joint));
    aiVector3D scale, place;
    aiQuaternion turn;
    nodes.nodes[i]->mTransformation.Decompose(scale, turn, place);
    NodeTransform transform{vec_of(place), quat_of(turn), vec_of(scale)};
    if (!transform.translation.allFinite() || !transform.scale.allFinite() ||
        !(transform.rotation.norm() > 1e-6)) {
      throw Error("has a node whose transform is not finite");
    }
    transform.rotation.normalize();
    rest.push_back(transform);
  }
  if (motion.joints.empty()) throw Error("has no skeleton: neither a skin nor an animated node");
  set_rest(rest, motion);
  state_fbx_units(scene, motion);
  if (!timeline.tracks.empty()) add_frames(timeline, joint_of, rest, motion);
  return motion;
}

}  // namespace

rig::SourceMotion read_fbx_rig(const std::string& path, const AnimationChoice& choice,
                               std::vector<std::string>* warnings) {
  std::error_code failed;
  if (std::filesystem::file_size(path, failed) > kLargestFbx && !failed) {
    throw FileError(path, 0, "is larger than 512 MiB; export the skeleton without meshes");
  }
  const std::string content = read_file(path);
  Assimp::Importer importer;
  // Pivots would become nodes of their own between the joints.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_MATERIALS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_TEXTURES, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_CAMERAS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_LIGHTS, false);
  try {
    // From memory, so that no file beside it is opened.
    const aiScene* scene = importer.ReadFileFromMemory(content.data(), content.size(),
                                                       aiProcess_ValidateDataStructure, "fbx");
    if (!scene || !scene->mRootNode) {
      throw Error(
          fmt::format("cannot be read as FBX: {}; export it again as FBX binary 7.4, or "
                      "as glTF",
                      importer.GetErrorString()));
    }
    return motion_of_scene(*scene, choice, path, warnings);
  } catch (const FileError&) {
    throw;
  } catch (const std::exception& error) {
    throw FileError(path, 0, error.what());
  }
}

rig::SourceMotion read_fbx(const std::string& path, const AnimationChoice& choice,
                           std::vector<std::string>* warnings) {
  rig::SourceMotion motion = read_fbx_rig(path, choice, warnings);
  if (motion.frames == 0) {
    throw FileError(path, 0,
                    "has no animation of its skeleton; a character without motion goes into "
                    "`remomask retarget --character`");
  }
  return motion;
}

}  // namespace remomask::scenes
