#pragma once

#include <vector>

#include "motion/vector.h"
#include "rig/rest_skeleton.h"

namespace remomask::rig {

/// World rotations of the joints for every frame.
using WorldRotations = std::vector<std::array<Quat, kRigJoints>>;

/// The rotations that bring the T-pose of `rest` to these poses, which have its bone lengths and
/// its shapes of pelvis and chest (RigidFit::fit).
///
/// Pelvis and chest follow from three joints each, and the spine turns by thirds between them.
/// Collars, neck and feet take the shortest arc from where their parent carries them; upper arms
/// and thighs turn about themselves as limb_rotations() says. Head and hands go with the bone
/// before them, and toes bend where a foot on its tip would push them through the floor.
WorldRotations solve_world_rotations(const std::vector<Pose>& poses, const RestSkeleton& rest,
                                     double fps);

}  // namespace remomask::rig
