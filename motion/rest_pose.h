#pragma once

#include "motion/vector.h"
#include "remomask/skeleton.h"

namespace remomask::motion {

/// Unit directions of the bones in a T-pose (arms along +X and -X, legs down, feet forward),
/// indexed by the joint that ends the bone. Unlike with the historical `Skeleton::rest_directions`,
/// raised arms do not point opposite to their rest direction, and left is left in both skeletons.
const std::vector<Vec3>& t_pose_directions(const Skeleton& skeleton);

}  // namespace remomask::motion
