#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "remomask/motion_file.h"
#include "rig/rest_skeleton.h"

namespace remomask::rig {

/// Names of a written skeleton: of the root joint, and of the 22 joints in the order of
/// humanml_skeleton().
struct NamePreset {
  JointNames names;
  std::string_view option;  ///< as --names has it
  std::string_view root;
  std::array<std::string_view, kRigJoints> joints;
};

const std::vector<NamePreset>& name_presets();
const NamePreset& name_preset(JointNames names);

/// The preset whose 22 joints are all among these names; null if there is none.
const NamePreset* find_name_preset(const std::vector<std::string>& names);

}  // namespace remomask::rig
