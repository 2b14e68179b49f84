#include "scenes/gltf_writer.h"

#include <fmt/format.h>

#include "remomask/error.h"
#include "remomask/version.h"
#include "rig/forward_kinematics.h"
#include "rig/mannequin.h"
#include "rig/rest_skeleton.h"
#include "scenes/gltf_builder.h"
#include "scenes/vrma.h"

namespace remomask::scenes {

namespace {

constexpr size_t kGltfJoints = rig::kRigJoints + 1;  // the root joint comes first

/// Where the joints of the T-pose are, which stands on the floor.
std::vector<Vec3> rest_positions(const JointRotations& motion) {
  std::vector<Vec3> positions;
  for (size_t j = 0; j < kGltfJoints; ++j) {
    const Vec3 offset = rig::to_vec(motion.rest_offsets[j]);
    const int parent = motion.parents[j];
    positions.push_back(parent < 0 ? offset
                                   : Vec3(positions[static_cast<size_t>(parent)] + offset));
  }
  return positions;
}

/// Nodes of the joints from `first` on.
void add_nodes(tinygltf::Model& model, const JointRotations& motion, size_t first) {
  model.nodes.resize(kGltfJoints - first);
  for (size_t j = first; j < kGltfJoints; ++j) {
    tinygltf::Node& node = model.nodes[j - first];
    node.name = motion.joint_names[j];
    const Vector3& offset = motion.rest_offsets[j];
    if (j > 0) node.translation.assign(offset.begin(), offset.end());
    if (j > first) {
      const auto parent = static_cast<size_t>(motion.parents[j]);
      model.nodes[parent - first].children.push_back(static_cast<int>(j - first));
    }
  }
  model.scenes.resize(1);
  model.scenes[0].nodes = {0};
  model.defaultScene = 0;
}

void add_materials(tinygltf::Model& model) {
  const auto material = [](const char* name, std::vector<double> colour, double roughness) {
    tinygltf::Material result;
    result.name = name;
    result.pbrMetallicRoughness.baseColorFactor = std::move(colour);
    result.pbrMetallicRoughness.metallicFactor = 0;
    result.pbrMetallicRoughness.roughnessFactor = roughness;
    return result;
  };
  model.materials = {material("Body", {0.62, 0.66, 0.72, 1}, 0.75),
                     material("Accent", {0.1, 0.16, 0.28, 1}, 0.6)};
}

void add_mannequin(tinygltf::Model& model, GltfBuilder& builder, const JointRotations& motion,
                   size_t first) {
  const std::vector<Vec3> rest = rest_positions(motion);
  rig::SkinnedMesh body = rig::make_mannequin({rest.begin() + 1, rest.end()});
  tinygltf::Skin skin;
  skin.name = "Mannequin";
  skin.skeleton = 0;
  std::vector<std::array<float, 16>> inverse_bind;
  for (size_t j = first; j < kGltfJoints; ++j) {
    skin.joints.push_back(static_cast<int>(j - first));
    const Vector3 back = rig::from_vec(-rest[j]);
    inverse_bind.push_back({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, back[0], back[1], back[2], 1});
  }
  skin.inverseBindMatrices = builder.add(inverse_bind, TINYGLTF_TYPE_MAT4);
  model.skins.push_back(std::move(skin));

  // The root is a joint of the skin as well, so that engines which build a skeleton from it have
  // it.
  const auto shift = static_cast<uint8_t>(1 - first);
  for (size_t v = 0; v < body.joints.size(); ++v) {
    for (size_t k = 0; k < 4; ++k) {
      if (body.weights[v][k] > 0) body.joints[v][k] += shift;
    }
  }
  const int positions =
      builder.add(body.positions, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER, true);
  const int normals = builder.add(body.normals, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
  const int joints = builder.add(body.joints, TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER);
  const int weights = builder.add(body.weights, TINYGLTF_TYPE_VEC4, TINYGLTF_TARGET_ARRAY_BUFFER);
  tinygltf::Mesh mesh;
  mesh.name = "Mannequin";
  for (const rig::SkinnedMesh::Part& part : body.parts) {
    std::vector<std::array<uint16_t, 1>> indices;
    for (const uint16_t index : part.triangles) indices.push_back({index});
    tinygltf::Primitive primitive;
    primitive.attributes = {
        {"POSITION", positions}, {"NORMAL", normals}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}};
    primitive.indices =
        builder.add(indices, TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = part.surface == rig::Surface::body ? 0 : 1;
    mesh.primitives.push_back(std::move(primitive));
  }
  model.meshes.push_back(std::move(mesh));
  tinygltf::Node node;
  node.name = "Mannequin";
  node.mesh = 0;
  node.skin = 0;
  model.nodes.push_back(std::move(node));
  model.scenes[0].nodes.push_back(static_cast<int>(model.nodes.size()) - 1);
  add_materials(model);
}

class AnimationWriter {
 public:
  AnimationWriter(GltfBuilder& builder, const JointRotations& motion, size_t first)
      : builder_(builder), motion_(motion), first_(first) {
    std::vector<std::array<float, 1>> times;
    for (int t = 0; t < motion.frames; ++t) times.push_back({static_cast<float>(t / motion.fps)});
    times_ = builder.add(times, TINYGLTF_TYPE_SCALAR, 0, true);
  }

  void path(bool root_motion) {
    const float standing = motion_.rest_offsets[1][1];
    std::vector<Vector3> root, pelvis;
    for (const Vector3& p : motion_.root) {
      root.push_back({p[0], 0, p[2]});
      pelvis.push_back({root_motion ? 0 : p[0], p[1] + standing, root_motion ? 0 : p[2]});
    }
    if (root_motion) translate(0, root);
    translate(1, pelvis);
  }

  void rotations_of(size_t joint) {
    std::vector<Quaternion> keys;
    for (int t = 0; t < motion_.frames; ++t) {
      keys.push_back(motion_.rotation(t, static_cast<int>(joint)));
    }
    channel(joint, "rotation", builder_.add(keys, TINYGLTF_TYPE_VEC4));
  }

  tinygltf::Animation finish() { return std::move(animation_); }

 private:
  void translate(size_t joint, const std::vector<Vector3>& keys) {
    channel(joint, "translation", builder_.add(keys, TINYGLTF_TYPE_VEC3));
  }

  void channel(size_t joint, const char* property, int output) {
    tinygltf::AnimationSampler sampler;
    sampler.input = times_;
    sampler.output = output;
    tinygltf::AnimationChannel result;
    result.sampler = static_cast<int>(animation_.samplers.size());
    result.target_node = static_cast<int>(joint - first_);
    result.target_path = property;
    animation_.samplers.push_back(sampler);
    animation_.channels.push_back(result);
  }

  GltfBuilder& builder_;
  const JointRotations& motion_;
  size_t first_;  ///< joint of the first node
  int times_ = 0;
  tinygltf::Animation animation_;
};

void check_animations(const std::vector<GltfAnimation>& animations) {
  if (animations.empty()) throw Error("a glTF file needs at least one motion");
  for (const GltfAnimation& animation : animations) {
    const JointRotations& motion = animation.motion;
    if (motion.parents.size() != kGltfJoints || motion.frames < 1 || !(motion.fps > 0)) {
      throw Error(fmt::format(
          "motion \"{}\" cannot be written: it needs 23 joints and at least one frame, and has "
          "{} and {}",
          animation.name, motion.joints(), motion.frames));
    }
  }
}

}  // namespace

std::string write_gltf(const std::vector<GltfAnimation>& animations, const GltfOptions& options) {
  check_animations(animations);
  const JointRotations& first_motion = animations[0].motion;
  const size_t first = options.root_node ? 0 : 1;
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "remomask " REMOMASK_VERSION;
  GltfBuilder builder(model);
  add_nodes(model, first_motion, first);
  if (options.vrm_animation) {
    add_vrm_animation(model, static_cast<int>(1 - first));
  } else if (options.mannequin) {
    add_mannequin(model, builder, first_motion, first);
  }
  const bool root_motion = options.root_motion && options.root_node;
  for (const GltfAnimation& animation : animations) {
    AnimationWriter writer(builder, animation.motion, first);
    writer.path(root_motion);
    for (size_t j = root_motion ? 0 : 1; j < kGltfJoints; ++j) writer.rotations_of(j);
    tinygltf::Animation made = writer.finish();
    made.name = animation.name;
    if (animation.extras) made.extras = gltf_value(*animation.extras);
    model.animations.push_back(std::move(made));
  }
  return gltf_bytes(model);
}

}  // namespace remomask::scenes
