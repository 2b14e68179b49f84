#pragma once

#include "remomask/motion.h"

namespace remomask::formats {

/// Axis that points up in raw positions of the 22 joints: 'X', 'Y' or 'Z'. The body's long axis
/// over the clip counts most; the rest pose (one frame; may be null) and the convention of Y up
/// decide for clips that crawl.
char detect_up_axis(const Motion& raw, const Motion* rest_pose);

/// Metres per unit: among the units in use, the one that gives the legs a plausible length,
/// otherwise the scale that makes them 0.83 m long. Throws Error if a leg has no length.
double detect_metres_per_unit(const Motion& raw);

/// Turns positions so that `up_axis` becomes Y; right-handed.
void turn_up_axis(Motion& motion, char up_axis);

}  // namespace remomask::formats
