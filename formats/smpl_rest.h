#pragma once

#include <array>

#include "motion/vector.h"

namespace remomask::formats {

/// Offsets of the 22 joints from their parents in a T-pose like that of the SMPL bodies, metres, Y
/// up, facing +Z: axis-angle poses of SMPL, SMPL-H and SMPL-X turn these bones. The directions are
/// our own estimate of a standing body, the lengths those of humanml_skeleton(), the same on both
/// sides; the shape of a certain person is not in it.
const std::array<Vec3, 22>& smpl_rest_offsets();

}  // namespace remomask::formats
