#pragma once

#include <string>
#include <vector>

#include "rig/source_motion.h"
#include "scenes/gltf_document.h"

namespace remomask::scenes {

struct AnimationChoice {
  /// Name of the animation, or its number from 0; empty: the first. Several unnamed ones are
  /// chosen by number.
  std::string animation;
};

/// A skeleton of a file that also knows where it came from.
struct GltfRig {
  rig::SourceMotion motion;           ///< no frames where the file has no animation
  std::vector<int> nodes;             ///< node of every joint
  std::vector<std::string> warnings;  ///< what was ignored or chosen, for people
};

/// The joints of the skins with the nodes above them, or of all animated trees where there is no
/// skin; the rest pose; and one animation, sampled at the rate of its keys (30 per second where
/// they are sparse). Scales are multiplied into translations. Meshes, morphs and images are
/// ignored. Throws FileError.
GltfRig read_gltf_rig(const GltfDocument& document, const AnimationChoice& choice = {});

/// The motion of a .glb, .gltf, .vrm or .vrma file. Throws FileError for a file without animation.
/// `warnings`, if given, is appended to.
rig::SourceMotion read_gltf(const std::string& path, const AnimationChoice& choice = {},
                            std::vector<std::string>* warnings = nullptr);

}  // namespace remomask::scenes
