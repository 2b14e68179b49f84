#include "scenes/vrma.h"

#include "rig/joint_names.h"
#include "scenes/gltf_builder.h"

namespace remomask::scenes {

void add_vrm_animation(tinygltf::Model& model, int first_joint) {
  nlohmann::json bones;
  const auto& names = rig::name_preset(JointNames::vrm).joints;
  for (size_t j = 0; j < names.size(); ++j) {
    bones[std::string(names[j])] = {{"node", first_joint + static_cast<int>(j)}};
  }
  const char* name = "VRMC_vrm_animation";
  model.extensions[name] =
      gltf_value({{"specVersion", "1.0"}, {"humanoid", {{"humanBones", bones}}}});
  model.extensionsUsed.push_back(name);
}

}  // namespace remomask::scenes
