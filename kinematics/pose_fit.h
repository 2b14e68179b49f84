#pragma once

#include <vector>

#include "motion/vector.h"
#include "remomask/motion.h"

namespace remomask::kinematics {

/// Mean length over time of the bone that ends in each joint, metres; 0 for the root.
std::vector<double> mean_bone_lengths(const Motion& motion, const Skeleton& skeleton);

/// Moves the joints of one pose that are `free` towards `target` so that every bone that begins or
/// ends at one of them has its length; the other joints stay. `pose` and `target` hold all joints
/// in metres. Where a free joint carries a fixed one (a spine between fixed legs and fixed
/// shoulders), the bones of `pose` must have these lengths on entry; the joint then moves as close
/// to its target as the bones allow (Gauss-Newton on the length constraints, in steps from the
/// given pose). Joints that carry nothing fixed take the direction of their target's bone.
void fit_free_joints(std::vector<Vec3>& pose, const std::vector<Vec3>& target,
                     const std::vector<bool>& free, const std::vector<double>& lengths,
                     const Skeleton& skeleton);

/// Two-bone inverse kinematics: position of the joint between `root` and `end` for bones of lengths
/// `upper` and `lower`, bent towards `hint`. An end out of reach is moved along its line from the
/// root to where it can be reached.
Vec3 bend_joint(const Vec3& root, Vec3& end, const Vec3& hint, double upper, double lower);

}  // namespace remomask::kinematics
