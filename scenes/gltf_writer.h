#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "remomask/rotations.h"

namespace remomask::scenes {

/// One animation of a glTF file.
struct GltfAnimation {
  std::string name;
  JointRotations motion;                   ///< 23 joints, as rig::rotations_to_write() gives them
  const nlohmann::json* extras = nullptr;  ///< an object that is stored with it; null: none
};

struct GltfOptions {
  bool mannequin = true;  ///< a skinned body, so that a viewer shows somebody
  /// A node above the pelvis, on the floor; false: the pelvis is the top.
  bool root_node = true;
  /// That node carries the path over the ground and the heading, the pelvis its height; false: it
  /// stays at the origin, and the pelvis carries all.
  bool root_motion = false;
  bool vrm_animation = false;  ///< VRMC_vrm_animation: a skeleton without a body
};

/// A binary glTF 2.0 file (.glb, .vrma): metres, Y up, facing +Z, the T-pose standing on the floor,
/// and LINEAR samplers with a key a frame. All animations move the skeleton of the first one.
/// Throws Error for no animation, no frame, or a skeleton that is not of 23 joints.
std::string write_gltf(const std::vector<GltfAnimation>& animations,
                       const GltfOptions& options = {});

}  // namespace remomask::scenes
