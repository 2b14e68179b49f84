#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "motion/vector.h"

namespace remomask::rig {

/// A joint of a file's skeleton in its rest pose, in the file's units and axes.
struct SourceJoint {
  std::string name;
  int parent = -1;                   ///< -1 for a root; parents come before their children
  Vec3 offset = Vec3::Zero();        ///< from the parent, in the parent's axes
  Quat rotation = Quat::Identity();  ///< of the rest pose, relative to the parent
  std::optional<Vec3> end_site;      ///< tip of the bone, in the joint's axes, where it is given
};

/// A skeleton with its motion as glTF, FBX, ASF/AMC and AMASS files give it: the local transform of
/// every joint in every frame. Scales are multiplied into the translations by whoever reads them.
struct SourceMotion {
  std::vector<SourceJoint> joints;
  int frames = 0;
  double fps = 0;
  std::vector<float> rotations;           ///< [frames][joints][4], x y z w
  std::vector<float> translations;        ///< [frames][joints][3], from the parent
  std::optional<double> metres_per_unit;  ///< where the format states it
  std::optional<char> up_axis;            ///< 'X', 'Y' or 'Z', where the format states it

  int find_joint(std::string_view name) const;  ///< -1 if absent
};

/// Writes the world position and rotation of one joint in `frame` (-1: the rest pose) into its
/// places of `positions` and `rotations`, which hold those of its parent already.
void place_joint(const SourceMotion& source, int frame, size_t joint, std::vector<Vec3>& positions,
                 std::vector<Quat>& rotations);

/// World position of every joint in `frame`; the rest pose for frame -1.
std::vector<Vec3> world_positions(const SourceMotion& source, int frame);

}  // namespace remomask::rig
