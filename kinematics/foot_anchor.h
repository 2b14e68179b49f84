#pragma once

#include <array>
#include <vector>

#include "motion/features.h"

namespace remomask::kinematics {

/// Whether the left and the right foot stand, for every frame.
using FootContacts = std::vector<std::array<bool, 2>>;

/// Reads contacts from features: a foot stands where the channel of its toe is above one half. Gaps
/// of one frame are closed, then contacts shorter than three frames are dropped.
FootContacts read_contacts(const motion::Features& features, const Skeleton& skeleton);

/// Moves the whole body over the ground so that standing feet do not slide. The mean slide of the
/// standing feet from each frame to the next is subtracted from the root's path, from the first
/// frame on, smoothed over three frames. A foot that slides faster than half of `fastest` (m/s)
/// counts less, and not at all from `fastest` on: such a body is travelling, and holding its feet
/// would stop it. Heights and poses stay. Throws Error unless there are contacts for every frame.
void anchor_to_feet(Motion& motion, const FootContacts& contacts, const Skeleton& skeleton,
                    double fastest = 1);

}  // namespace remomask::kinematics
