#include "scenes/fbx_writer.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <memory>

#include "remomask/error.h"
#include "scenes/fbx_binary.h"

namespace remomask::scenes {

namespace {

template <typename Key>
void to_seconds(Key* keys, unsigned count, double ticks_per_second) {
  for (unsigned i = 0; i < count; ++i) keys[i].mTime /= ticks_per_second;
}

/// assimp's writer takes key times for seconds, whatever the scene says; returns the length.
double keys_in_seconds(aiAnimation& animation) {
  const double rate = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 1;
  for (unsigned c = 0; c < animation.mNumChannels; ++c) {
    aiNodeAnim& track = *animation.mChannels[c];
    to_seconds(track.mPositionKeys, track.mNumPositionKeys, rate);
    to_seconds(track.mRotationKeys, track.mNumRotationKeys, rate);
    to_seconds(track.mScalingKeys, track.mNumScalingKeys, rate);
  }
  animation.mDuration /= rate;
  animation.mTicksPerSecond = 1;
  return animation.mDuration;
}

}  // namespace

std::string fbx_from_glb(const std::string& glb, double fps) {
  Assimp::Importer importer;
  if (!importer.ReadFileFromMemory(glb.data(), glb.size(), 0, "glb")) {
    throw Error(std::string("FBX cannot be written: ") + importer.GetErrorString());
  }
  const std::unique_ptr<aiScene> scene(importer.GetOrphanedScene());
  FbxFacts facts;
  facts.fps = fps;
  for (unsigned a = 0; a < scene->mNumAnimations; ++a) {
    facts.seconds.push_back(keys_in_seconds(*scene->mAnimations[a]));
  }
  constexpr float kCentimetresPerUnit = 100;
  if (!scene->mMetaData) scene->mMetaData = new aiMetadata;
  scene->mMetaData->Add("UnitScaleFactor", kCentimetresPerUnit);
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(scene.get(), "fbx");
  if (!blob) throw Error(std::string("FBX cannot be written: ") + exporter.GetErrorString());
  return complete_fbx({static_cast<const char*>(blob->data), blob->size}, facts);
}

}  // namespace remomask::scenes
