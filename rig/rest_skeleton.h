#pragma once

#include <array>

#include "motion/vector.h"
#include "remomask/motion.h"

namespace remomask::rig {

constexpr size_t kRigJoints = 22;

/// A value for each of the 22 joints of humanml_skeleton().
using Pose = std::array<Vec3, kRigJoints>;

/// A rigid skeleton in its T-pose: it stands with its soles on y = 0 and faces +Z, its left is +X.
struct RestSkeleton {
  Pose offsets;  ///< from the parent, metres; of the pelvis from the ground below it
  Pose tips;     ///< from head, hands and toes to the ends of their bones; zero for other joints
};

/// The skeleton that every motion is put onto. Its bones are as long as those of
/// humanml_skeleton(). The shapes of pelvis and chest are a compromise between the capture systems
/// whose motions are in use, which differ by some centimetres.
const RestSkeleton& human_rest();

/// A skeleton with the mean bone lengths of a motion, and with its mean shapes of pelvis and chest.
RestSkeleton performer_rest(const Motion& motion);

/// Rotation that takes pelvis or chest of a T-pose to three points of a posed body: the line from
/// `right` to `left` is met, and `top` lies in its plane.
Quat rotation_of_triangle(const Vec3& left, const Vec3& right, const Vec3& top, const Vec3& to_left,
                          const Vec3& to_right, const Vec3& to_top);

}  // namespace remomask::rig
