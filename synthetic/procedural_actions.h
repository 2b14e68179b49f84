#pragma once

#include <vector>

#include "synthetic/procedural.h"
#include "synthetic/procedural_body.h"

namespace remomask::synthetic {

/// Which limb an action uses.
enum class ActionSide { left = 0, right = 1, both = 2 };

inline bool uses_side(ActionSide which, int side) {
  return which == ActionSide::both || static_cast<int>(which) == side;
}

using Poses = std::vector<BodyPose>;

/// Motions on the spot; each returns its poses at 20 fps.
Poses make_stand(const ProceduralParameters& p);
Poses make_wave(const ProceduralParameters& p, ActionSide side);
Poses make_raise(const ProceduralParameters& p, ActionSide side);
Poses make_point(const ProceduralParameters& p, ActionSide side);
Poses make_clap(const ProceduralParameters& p);
Poses make_throw(const ProceduralParameters& p, ActionSide side);
Poses make_stretch(const ProceduralParameters& p);
Poses make_bow(const ProceduralParameters& p, double degrees);
Poses make_sway(const ProceduralParameters& p);
/// `alternate`: left and right in turn, `side` first.
Poses make_punch(const ProceduralParameters& p, ActionSide side, bool alternate);

Poses make_squat(const ProceduralParameters& p);
Poses make_sit(const ProceduralParameters& p, bool stand_up);
Poses make_kick(const ProceduralParameters& p, ActionSide side, bool sideways);
/// Jumps of `height` metres, `distance` metres forward each.
Poses make_jump(const ProceduralParameters& p, double height, double distance);
Poses make_jumping_jacks(const ProceduralParameters& p);

/// Locomotion with footsteps.
enum class GaitKind {
  walk,
  backward,
  sideways,
  circle,
  tiptoe,
  limp,
  sneak,
  march,
  crouch,
  step_over,
  stop,
  turn_after,
  wave_after,
  run
};
Poses make_gait(const ProceduralParameters& p, GaitKind kind, ActionSide side);
Poses make_turn(const ProceduralParameters& p, ActionSide side, double degrees);

/// Arm of a wave at `time` within [from, to].
ArmPose waving_arm(const ArmPose& rest, double time, double from, double to, double amplitude);

/// Moves faster than usual: > 1 for energetic, < 1 for tired and old.
double style_tempo(const std::string& style);

}  // namespace remomask::synthetic
