#pragma once

#include <vector>

#include "rig/humanoid.h"
#include "rig/name_reading.h"

namespace remomask::rig {

/// Fills in pelvis, spine, neck and head of a body whose limbs are known: by their names where
/// they have some, else by what lies between the limbs.
void find_trunk(const SkeletonView& skeleton, const std::vector<NameReading>& names,
                Humanoid& body);

}  // namespace remomask::rig
