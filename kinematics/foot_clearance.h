#pragma once

#include "remomask/motion.h"

namespace remomask::kinematics {

struct FootClearanceOptions {
  double swing_speed = 1;  ///< m/s over the ground: a toe above it swings
  /// A swinging toe is at least so high in the middle, m for each m/s that the body moves over
  /// the ground: three quarters of the swings of walking and running people are
  /// above 0.036 to 0.046, at any speed from 0.5 to 5 m/s (the data pack, train).
  double height = 0.04;
  double most = 0.12;  ///< m: no foot is raised by more
  int fade = 2;        ///< frames over which a correction begins and ends
};

/// Raises swinging feet that brush over the floor, at y = 0: where a toe swings, all of the
/// swing is raised so far that its median height reaches that of real ones. Feet that swing
/// high enough, and standing ones, stay. Knees follow, bone lengths stay (move_foot()).
void raise_swings(Motion& motion, const Skeleton& skeleton,
                  const FootClearanceOptions& options = {});

}  // namespace remomask::kinematics
