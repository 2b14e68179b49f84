#pragma once

#include <string>
#include <vector>

#include "formats/motion_writing.h"
#include "rig/source_motion.h"

namespace remomask::formats {

/// The motion on the skeleton of the figure that the options name, as .glb or .bvh (`extension`). A
/// .glb of a glTF figure keeps its meshes, skins, materials and nodes; only its animations are
/// replaced. Of other figures the skeleton is written. Throws FileError for an unusable figure.
WrittenFile write_on_character(const WritingJob& job, std::string_view extension);

/// The rest pose of a figure without its motion. Throws FileError.
rig::SourceMotion read_rig(const std::string& path, std::vector<std::string>& warnings);

}  // namespace remomask::formats
