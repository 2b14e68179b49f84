#pragma once

#include <string>
#include <vector>

#include "rig/source_motion.h"
#include "scenes/gltf_reader.h"

namespace remomask::scenes {

/// The skeleton of an .fbx file and one animation of it (no frames where it has none), read by
/// assimp: the joints of the skins and what is animated, with the nodes above them. Throws
/// FileError. `warnings`, if given, is appended to.
rig::SourceMotion read_fbx_rig(const std::string& path, const AnimationChoice& choice = {},
                               std::vector<std::string>* warnings = nullptr);

/// The same; throws FileError for a file without animation.
rig::SourceMotion read_fbx(const std::string& path, const AnimationChoice& choice = {},
                           std::vector<std::string>* warnings = nullptr);

}  // namespace remomask::scenes
