#pragma once

#include "motion/vector.h"
#include "remomask/skeleton.h"

namespace remomask::motion {

/// Unit directions of the bones in a T-pose (arms along +X and -X, legs down,
/// feet to the front), by joint that ends the bone. Unlike the historical
/// `Skeleton::rest_directions`, raised arms are far from their opposites, and
/// left is left in both skeletons.
const std::vector<Vec3>& t_pose_directions(const Skeleton& skeleton);

}  // namespace remomask::motion
