#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rig/humanoid.h"
#include "rig/name_reading.h"

namespace remomask::rig {

/// Finds a body by its shape alone: two like chains below (legs), two like chains above (arms), and
/// something between the arms that goes on upwards. Left and right are told by names where names
/// tell them, else by where the toes point. Empty if there is no such shape.
std::optional<Humanoid> find_body_by_shape(const SkeletonView& skeleton,
                                           const std::vector<NameReading>& names);

/// The pose in which the legs hang down from the trunk as they do in a standing body, if there is
/// one: the rest pose or the first frame. Null if there is none.
const SkeletonPose* standing_pose(const SkeletonView& skeleton, const Humanoid& body);

/// Why a body with all its parts is that of an animal on four legs; empty if it is not.
std::string why_no_human(const SkeletonView& skeleton, const std::vector<NameReading>& names,
                         const Humanoid& body);

/// Between the hips, in a pose.
Vec3 hip_centre(const SkeletonPose& pose, const Humanoid& body);

/// The top of the trunk: neck, else head.
int trunk_top(const Humanoid& body);

}  // namespace remomask::rig
