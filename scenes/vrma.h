#pragma once

namespace tinygltf {
class Model;
}

namespace remomask::scenes {

/// Adds the extension VRMC_vrm_animation 1.0: which node is which bone of a VRM figure. The 22
/// joints are the nodes from `first_joint` on, in the order of humanml_skeleton().
void add_vrm_animation(tinygltf::Model& model, int first_joint);

}  // namespace remomask::scenes
