#pragma once

#include <array>
#include <string>
#include <vector>

#include "remomask/export.h"
#include "remomask/motion.h"

namespace remomask {

using Vector3 = std::array<float, 3>;
using Quaternion = std::array<float, 4>;  ///< x, y, z, w; unit length

/// A motion as a game engine plays it: joint rotations over a T-pose that stands on y = 0 and
/// faces +Z. The skeleton is rigid, and only the root moves.
struct JointRotations {
  int frames = 0;
  double fps = 20;
  std::vector<std::string> joint_names;
  std::vector<int> parents;  ///< -1 for the root; parents come first
  /// [joints] from the parent in the T-pose, metres; for the root from the ground below it.
  std::vector<Vector3> rest_offsets;
  /// [joints] from a joint without children to the end of its bone (top of the head, finger tips,
  /// tips of the toes), metres; zero for all others.
  std::vector<Vector3> tips;
  std::vector<Vector3> root;          ///< [frames] position of the root, metres
  std::vector<Quaternion> rotations;  ///< [frames][joints] relative to the parent

  int joints() const { return static_cast<int>(parents.size()); }
  const Quaternion& rotation(int frame, int joint) const {
    return rotations[static_cast<size_t>(frame) * parents.size() + static_cast<size_t>(joint)];
  }
};

struct RotationOptions {
  /// false: every motion is put onto the same skeleton, that of HumanML3D. true: bones are as long
  /// as in the motion.
  bool own_proportions = false;
  /// A motion whose bones, pelvis and chest are rigid to a millimetre, as one that came from a file
  /// with a skeleton, keeps its shapes of pelvis and chest, so that every joint stays where it was.
  /// Generated motions are not rigid: they are always put onto the one skeleton.
  bool keep_rigid = false;
};

/// Puts a motion of 22 joints onto a rigid skeleton and solves the rotations. Throws Error for
/// another number of joints and for positions that are not finite.
REMOMASK_API JointRotations solve_rotations(const Motion& motion,
                                            const RotationOptions& options = {});

}  // namespace remomask
