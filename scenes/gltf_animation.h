#pragma once

#include <optional>
#include <string>

#include "scenes/gltf_document.h"
#include "scenes/node_motion.h"

namespace remomask::scenes {

/// The animation of `wanted` (a name, or a number from 0; empty: the first that moves a joint of a
/// skin or, in a file without skins, any node); nothing where the file has none. Tracks of weights
/// are left out. Throws FileError.
std::optional<NodeTimeline> read_gltf_timeline(const GltfDocument& document,
                                               const std::string& wanted);

}  // namespace remomask::scenes
