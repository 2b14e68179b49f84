#pragma once

#include <nlohmann/json_fwd.hpp>

#include "kinematics/foot_anchor.h"
#include "remomask/motion.h"

namespace remomask::formats {

/// Whether the left and the right foot stand in every frame; nobody stands in a single frame's
/// unknown movement.
kinematics::FootContacts foot_contacts(const Motion& motion);

/// {"left": [[first, end], ...], "right": ...}: stretches of frames, the end not included.
nlohmann::json foot_contacts_json(const Motion& motion);

}  // namespace remomask::formats
