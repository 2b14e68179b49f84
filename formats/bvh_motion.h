#pragma once

#include "formats/bvh.h"
#include "remomask/rotations.h"

namespace remomask::formats {

/// A motion with a root joint (rig::RotationsToWrite) as a BVH file. "Root" has OFFSET zero and six
/// channels, every other joint three, Z Y X in degrees, unwrapped over time; head, hands and toes
/// have End Sites.
Bvh rotations_to_bvh(const JointRotations& motion, double units_per_metre);

}  // namespace remomask::formats
