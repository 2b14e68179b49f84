#pragma once

#include <vector>

#include "motion/vector.h"
#include "remomask/motion.h"

namespace remomask::kinematics {

/// Mean length over time of the bone that ends in each joint, metres; 0 for the root.
std::vector<double> mean_bone_lengths(const Motion& motion, const Skeleton& skeleton);

/// One pose: moves the joints with `free` towards `target` so that every bone
/// that ends in or begins at one of them has its length; the other joints stay.
/// `pose` and `target` hold all joints in metres; where a free joint carries a
/// fixed one (a spine between fixed legs and fixed shoulders), `pose` must hold
/// bones of these lengths on entry: the joint then goes as far towards its
/// target as the bones let it (Gauss-Newton on the length constraints, in steps
/// from the given pose). Joints that carry nothing fixed take the direction of
/// their target's bone.
void fit_free_joints(std::vector<Vec3>& pose, const std::vector<Vec3>& target,
                     const std::vector<bool>& free, const std::vector<double>& lengths,
                     const Skeleton& skeleton);

/// Two-bone inverse kinematics: where the joint between `root` and `end` comes
/// to lie for bones of lengths `upper` and `lower`, bent towards `hint`. An end
/// out of reach is moved on its line from the root to where it can be reached.
Vec3 bend_joint(const Vec3& root, Vec3& end, const Vec3& hint, double upper, double lower);

}  // namespace remomask::kinematics
