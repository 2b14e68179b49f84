#pragma once

#include <string>
#include <vector>

#include "formats/motion_writing.h"
#include "rig/source_motion.h"

namespace remomask::formats {

/// A user's own figure, and what is known about its joints.
struct CharacterChoice {
  std::string path;          ///< .glb, .gltf, .vrm, .bvh or .fbx
  std::string skeleton_map;  ///< as MotionFileOptions has it
};

/// The motion on the figure's skeleton, as .glb or .bvh (`extension`). A .glb of a glTF figure
/// keeps its meshes, skins, materials and nodes; only its animations are replaced. Of other figures
/// the skeleton is written. `warnings` is appended to. Throws FileError for an unusable figure.
WrittenFile write_on_character(const WritingJob& job, const CharacterChoice& choice,
                               const std::string& extension, std::vector<std::string>& warnings);

/// The rest pose of a figure without its motion. Throws FileError.
rig::SourceMotion read_rig(const std::string& path, std::vector<std::string>& warnings);

}  // namespace remomask::formats
