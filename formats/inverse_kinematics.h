#pragma once

#include <vector>

#include "formats/bvh.h"
#include "motion/vector.h"
#include "remomask/motion.h"

namespace remomask::formats {

/// Bone rotations of a motion over a T-pose rest skeleton.
struct Pose22 {
  std::vector<Vec3> rest_offsets;  ///< 22, from parent to joint in the T-pose, metres; root zero
  std::vector<Vec3> root;          ///< [frames] pelvis, metres
  std::vector<Quat> local;         ///< [frames][22] rotation of each joint relative to its parent
  /// [frames][22] translation of each joint in its parent's axes, metres: the
  /// rest offset, except for children of pelvis and spine3 in a clip that is not rigid there.
  std::vector<Vec3> translations;
  bool rigid = true;  ///< all translations are the rest offsets
};

/// Closed-form inverse kinematics of the 22 joints. Joints with several children (pelvis, spine3)
/// take the best rotation over them (Kabsch), and their children's offsets are the clip's own rigid
/// shape. Where the clip departs from that shape by more than half a millimetre (other skeletons,
/// generated motions), the children of these two joints carry translations, so that positions stay
/// exact. Joints with one child take the shortest arc from the direction that their parent carries,
/// which avoids sudden twists; the twist between pelvis and spine3 is spread over the spine.
Pose22 solve_pose(const Motion& motion);

/// The motion as a BVH file in centimetres at 20 fps: 22 joints "Hips",
/// "LeftUpLeg", ..., Euler angles Z Y X unwrapped over time, root OFFSET zero and its
/// position absolute. Joints with translations have position channels, too.
Bvh motion_to_bvh(const Motion& motion);

}  // namespace remomask::formats
