#pragma once

#include <array>
#include <string>
#include <vector>

#include "remomask/export.h"
#include "remomask/motion.h"

namespace remomask {

using Vector3 = std::array<float, 3>;
using Quaternion = std::array<float, 4>;  ///< x, y, z, w; unit length

/// A motion as a game engine plays it: joint rotations over a T-pose.
struct JointRotations {
  int frames = 0;
  double fps = 20;
  std::vector<std::string> joint_names;
  std::vector<int> parents;           ///< -1 for the root; parents come first
  std::vector<Vector3> rest_offsets;  ///< [joints] from the parent in the T-pose, metres
  std::vector<Vector3> root;          ///< [frames] position of the root, metres
  std::vector<Quaternion> rotations;  ///< [frames][joints] relative to the parent
  std::vector<Vector3> translations;  ///< [frames][joints] in the parent's axes, metres
  bool rigid = true;                  ///< every translation equals the rest offset

  int joints() const { return static_cast<int>(parents.size()); }
  const Quaternion& rotation(int frame, int joint) const {
    return rotations[static_cast<size_t>(frame) * parents.size() + static_cast<size_t>(joint)];
  }
};

/// Solves the rotations of a motion of 22 joints by closed-form inverse kinematics. Throws
/// Error for another skeleton.
REMOMASK_API JointRotations solve_rotations(const Motion& motion);

}  // namespace remomask
