#pragma once

#include <array>
#include <string>
#include <vector>

#include "remomask/export.h"

namespace remomask {

/// A joint hierarchy with everything that the 263-d (12 J - 1) features need.
/// Y up, metres (KIT-ML: its own unit), character faces +Z, its left is +X.
struct REMOMASK_API Skeleton {
  std::string name;                      ///< "humanml3d" (22 joints) or "kit" (21)
  std::vector<std::string> joint_names;  ///< SMPL names: "pelvis", "left_hip", ...
  std::vector<int> parents;              ///< -1 for the root; parents come first
  std::vector<std::vector<int>> chains;  ///< kinematic chains in the order of the features
  /// Unit direction of the bone that ends in the joint, in the T-pose; zero for the root.
  std::vector<std::array<double, 3>> rest_directions;
  std::vector<double> bone_lengths;  ///< of the uniform skeleton; 0 for the root
  std::vector<int> mirror;           ///< joint on the other side
  int right_hip, left_hip, right_shoulder, left_shoulder;
  int leg_upper, leg_lower;                ///< bones whose summed length gives the scale
  std::vector<int> left_feet, right_feet;  ///< ankle, toe
  double contact_threshold;                ///< squared displacement per frame
  double fps;                              ///< 20 (humanml3d), 12.5 (kit)

  int joints() const { return static_cast<int>(parents.size()); }
  int feature_dim() const { return 12 * joints() - 1; }
};

/// 22 SMPL joints of HumanML3D; bone lengths of its uniform skeleton.
REMOMASK_API const Skeleton& humanml_skeleton();
/// 21 joints of KIT-ML.
REMOMASK_API const Skeleton& kit_skeleton();
/// "humanml3d" or "kit". Throws Error for another name.
REMOMASK_API const Skeleton& skeleton_named(const std::string& name);

}  // namespace remomask
