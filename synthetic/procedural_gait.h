#pragma once

#include <functional>
#include <vector>

#include "synthetic/procedural_body.h"

namespace remomask::synthetic {

/// Velocity of the body in its own frame at a time.
struct PathVelocity {
  double left = 0, forward = 0;  ///< m/s
  double turn = 0;               ///< degrees/s, positive to the left
};

/// How a body walks or runs. Angles in degrees, lengths in metres.
struct GaitPlan {
  double duration = 4;       ///< seconds
  double first_lift = 0.3;   ///< the first foot leaves the floor
  double half_period = 0.5;  ///< seconds between two landings
  double limp = 0;           ///< share by which the stance on `limp_side` is shortened
  int limp_side = 0;
  int first_side = 1;
  int steps = 6;
  double duty = 0.62;       ///< share of the cycle that a foot is on the floor; < 0.5: running
  double clearance = 0.06;  ///< of the swinging foot
  std::function<double(int step)> extra_clearance;  ///< more of it for one step, may be empty
  double heel = 38, toe = 14;  ///< heel lift when leaving, toe lift when landing
  double tiptoe = 0;           ///< heel lift kept all the way
  double half_width = 0.09;    ///< of the stance
  double height = 0;           ///< of the pelvis, over the stand's
  double bob = 0.02, sway = 0.02;
  double arm_swing = 22, elbow = 15, elbow_swing = 12;
  double bend = 2;
  std::function<PathVelocity(double time)>
      velocity;                                 ///< zero before the first and after the last step
  std::function<double(double time)> activity;  ///< 0 standing .. 1 full gait
};

/// Time of the last landing.
double last_landing(const GaitPlan& plan);

/// Poses at 20 fps over the plan's duration. Feet stand still between landing
/// and leaving: each is put where the body will be in the middle of its stance.
std::vector<BodyPose> walk_poses(const GaitPlan& plan);

/// Puts the body into a relaxed stand at the origin with its feet on the floor.
BodyPose standing_pose(double half_width = 0.09);

}  // namespace remomask::synthetic
