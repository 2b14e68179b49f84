#pragma once

#include "rig/humanoid.h"
#include "rig/skeleton_map.h"

namespace remomask::rig {

/// Where the 22 joints lie in a body: on its joints, or between them where its spine has fewer or
/// more, and at End Sites or fixed points where it has no toes, hands, head or collar bones.
SkeletonMap map_of_body(const SkeletonView& skeleton, const Humanoid& body);

}  // namespace remomask::rig
