#pragma once

#include <string>

#include "motion/vector.h"

struct aiScene;

namespace remomask::testing_support {

/// World position of the node `name` in frame `frame` of the animation `animation` of a scene that
/// assimp has read, with a key a frame.
Vec3 node_position(const aiScene& scene, size_t animation, const std::string& name, int frame);

}  // namespace remomask::testing_support
