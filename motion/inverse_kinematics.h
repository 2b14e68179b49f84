#pragma once

#include <vector>

#include "motion/bvh.h"
#include "motion/motion.h"

namespace remomask {

/// Bone rotations of a motion over a T-pose rest skeleton.
struct Pose22 {
  std::vector<Vec3> rest_offsets;  ///< 22, from parent to joint in the T-pose, metres; root zero
  std::vector<Vec3> root;          ///< [frames] pelvis, metres
  std::vector<Quat> local;         ///< [frames][22] rotation of each joint relative to its parent
};

/// Closed-form inverse kinematics of the 22 joints. Joints with several
/// children (pelvis, spine3) take the best rotation over them (Kabsch); their
/// children's offsets are the clip's own rigid shape, so clips with rigid hips
/// and shoulders are met exactly. Joints with one child take the shortest arc
/// from the direction that their parent carries, hence no sudden twists; the
/// twist between pelvis and spine3 is spread over the spine.
Pose22 solve_pose(const Motion& motion);

/// The motion as a BVH file in centimetres at 20 fps: 22 joints "Hips",
/// "LeftUpLeg", ..., Euler angles Z Y X unwrapped over time, root OFFSET zero.
Bvh motion_to_bvh(const Motion& motion);

}  // namespace remomask
