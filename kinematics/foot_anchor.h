#pragma once

#include <array>
#include <vector>

#include "motion/features.h"

namespace remomask::kinematics {

/// For every frame, whether the left and the right foot stand.
using FootContacts = std::vector<std::array<bool, 2>>;

/// Contacts as the features say them: a foot stands where the channel of its toe
/// is above one half. Gaps of one frame are closed, then contacts of fewer than
/// three frames are left out.
FootContacts read_contacts(const motion::Features& features, const Skeleton& skeleton);

/// Moves the whole body over the ground so that standing feet do not slide: what
/// they slide on average from frame to frame is taken out of the root's path, from
/// the first frame on, smoothed over three frames. A foot that slides at more than
/// half of `fastest` (m/s) counts less, from `fastest` on nothing: such a body is on
/// its way, and holding its feet would stop it. Heights and poses stay. Throws Error
/// unless there are contacts for every frame.
void anchor_to_feet(Motion& motion, const FootContacts& contacts, const Skeleton& skeleton,
                    double fastest = 1);

}  // namespace remomask::kinematics
