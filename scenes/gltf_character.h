#pragma once

#include <string>

#include "scenes/gltf_reader.h"

namespace remomask::scenes {

/// A figure's file with the motion of `rig` as its only animation, as .glb. All else stays as it
/// is, members and extensions that this program does not know among it. Throws FileError for a
/// .gltf file whose images or buffers lie beside it: they would be lost.
std::string character_glb(GltfDocument document, const GltfRig& rig, const std::string& name,
                          const nlohmann::json& extras);

}  // namespace remomask::scenes
