#pragma once

#include <vector>

#include "rig/humanoid.h"
#include "rig/name_reading.h"

namespace remomask::rig {

/// The legs or arms that the names tell, where a name with two meanings is settled by the order of
/// the joints along the limb. Joints that are not named are -1.
LimbJoints find_leg(const SkeletonView& skeleton, const std::vector<NameReading>& names, Side side);
LimbJoints find_arm(const SkeletonView& skeleton, const std::vector<NameReading>& names, Side side);

}  // namespace remomask::rig
