#pragma once

#include "remomask/motion.h"

namespace remomask::kinematics {

struct FootClearanceOptions {
  double swing_speed = 1;  ///< m/s over the ground: a toe faster than this swings
  /// Minimum height of a swinging toe in the middle of its swing, in m for each m/s that the body
  /// moves over the ground. Three quarters of the swings of walking and running people are above
  /// 0.036 to 0.046, at any speed from 0.5 to 5 m/s (data packs, train).
  double height = 0.04;
  double max_raise = 0.12;  ///< m
  int fade = 2;             ///< frames over which a correction begins and ends
};

/// Raises swinging feet that brush over the floor, at y = 0. Where a toe swings, the whole swing is
/// raised until its median height reaches that of real swings. Feet that swing high enough and
/// standing feet stay. Knees follow and bone lengths stay (move_foot()).
void raise_swings(Motion& motion, const Skeleton& skeleton,
                  const FootClearanceOptions& options = {});

}  // namespace remomask::kinematics
