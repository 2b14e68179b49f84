#pragma once

#include <vector>

#include "tests/rig/rig_builder.h"

namespace remomask::testing_support {

/// Skeletons of programs, data sets and capture systems, as their files name the joints.
const std::vector<RigNames>& known_rigs();

}  // namespace remomask::testing_support
