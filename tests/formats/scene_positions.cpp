#include "tests/formats/scene_positions.h"

#include <assimp/anim.h>
#include <assimp/scene.h>

#include <stdexcept>

namespace remomask::testing_support {

namespace {

template <typename Keys>
auto key_of(const Keys* keys, unsigned count, int frame) {
  return keys[std::min(static_cast<unsigned>(frame), count - 1)].mValue;
}

aiMatrix4x4 local_transform(const aiAnimation& animation, const aiNode& node, int frame) {
  for (unsigned c = 0; c < animation.mNumChannels; ++c) {
    const aiNodeAnim& track = *animation.mChannels[c];
    if (track.mNodeName != node.mName) continue;
    return aiMatrix4x4(key_of(track.mScalingKeys, track.mNumScalingKeys, frame),
                       key_of(track.mRotationKeys, track.mNumRotationKeys, frame),
                       key_of(track.mPositionKeys, track.mNumPositionKeys, frame));
  }
  return node.mTransformation;
}

}  // namespace

Vec3 node_position(const aiScene& scene, size_t animation, const std::string& name, int frame) {
  const aiNode* node = scene.mRootNode->FindNode(name.c_str());
  if (!node || animation >= scene.mNumAnimations) throw std::runtime_error("no node " + name);
  aiMatrix4x4 world;
  for (; node; node = node->mParent) {
    world = local_transform(*scene.mAnimations[animation], *node, frame) * world;
  }
  return {world.a4, world.b4, world.c4};
}

}  // namespace remomask::testing_support
