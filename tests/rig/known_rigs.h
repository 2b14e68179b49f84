#pragma once

#include <vector>

#include "tests/rig/rig_builder.h"

namespace remomask::testing_support {

/// Skeletons of programs, data sets and capture systems, as their files name the joints.
const std::vector<RigNames>& known_rigs();

/// Those of them whose names follow no scheme that another program shares.
std::vector<RigNames> rigs_of_captures_and_games();

}  // namespace remomask::testing_support
