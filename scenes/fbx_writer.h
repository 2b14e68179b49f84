#pragma once

#include <string>

namespace remomask::scenes {

/// A binary FBX file (metres) with the skeleton, the body and the animations of the bytes of one of
/// our .glb files. Throws Error if the library fails.
std::string fbx_from_glb(const std::string& glb, double fps);

}  // namespace remomask::scenes
