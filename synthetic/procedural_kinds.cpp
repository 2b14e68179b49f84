#include "synthetic/procedural_kinds.h"

namespace remomask::synthetic {

namespace {

std::function<Poses(const ProceduralParameters&)> gait(GaitKind kind,
                                                       ActionSide side = ActionSide::both) {
  return [=](const ProceduralParameters& p) { return make_gait(p, kind, side); };
}

std::string turn_tag(ActionSide side) {
  return side == ActionSide::left ? "turn left" : "turn right";
}

void add_walks(ProceduralKinds& kinds) {
  kinds.push_back({
      .name = "walk-forward",
      .build = gait(GaitKind::walk),
      .phrases = {"{walk} forward", "{walk} straight ahead", "{take} steps forward"},
      .actions = {"walk"},
      .low_speed = 0.95,
      .high_speed = 1.4,
      .shortest = 3.5,
      .longest = 8,
      .styles = true,
  });
  kinds.push_back({
      .name = "walk-slow",
      .build = gait(GaitKind::walk),
      .phrases = {"slowly {walk} forward", "{walk} forward at a slow pace", "{walk} ahead slowly"},
      .actions = {"walk", "slow"},
      .low_speed = 0.5,
      .high_speed = 0.75,
      .shortest = 4,
      .longest = 9,
  });
  kinds.push_back({
      .name = "walk-fast",
      .build = gait(GaitKind::walk),
      .phrases = {"{walk} forward quickly", "{walk} forward at a brisk pace", "{walk} fast"},
      .actions = {"walk", "fast"},
      .low_speed = 1.55,
      .high_speed = 1.85,
      .shortest = 3,
      .longest = 6,
  });
  kinds.push_back({
      .name = "walk-backward",
      .build = gait(GaitKind::backward),
      .phrases = {"{walk} backward", "{walk} backwards", "{take} steps backward"},
      .actions = {"walk", "walk backward"},
      .low_speed = 0.5,
      .high_speed = 0.9,
      .shortest = 3,
      .longest = 7,
      .styles = true,
  });
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{
        .name = "walk-sideways",
        .build = gait(GaitKind::sideways, side),
        .phrases = {"{walk} sideways to the [side]", "{sidestep} to the [side]",
                    "{step} sideways to the [side]"},
        .actions = {"walk", "walk sideways"},
        .low_speed = 0.3,
        .high_speed = 0.55,
        .shortest = 3,
        .longest = 6,
    };
  });
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{
        .name = "walk-circle",
        .build = gait(GaitKind::circle, side),
        .phrases = {"{walk} in a circle to the [side]", "{walk} in a full circle, turning [side]",
                    "{walk} around in a circle towards the [side]"},
        .actions = {"walk", "circle", "turn", turn_tag(side)},
        .low_speed = 0.8,
        .high_speed = 1.25,
        .shortest = 6.5,
        .longest = 9,
        .styles = true,
    };
  });
  kinds.push_back({
      .name = "tiptoe",
      .build = gait(GaitKind::tiptoe),
      .phrases = {"{walk} forward on tiptoe", "{tiptoe} forward",
                  "{walk} on the balls of the feet"},
      .actions = {"walk", "tiptoe"},
      .low_speed = 0.5,
      .high_speed = 0.85,
      .shortest = 3.5,
      .longest = 7,
  });
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{
        .name = "limp",
        .build = gait(GaitKind::limp, side),
        .phrases = {"{limp} forward with a hurt [side] leg", "{walk} with a limp of the [side] leg",
                    "{limp} forward, favoring the injured [side] leg"},
        .actions = {"walk", "limp"},
        .low_speed = 0.5,
        .high_speed = 0.8,
        .shortest = 4,
        .longest = 8,
    };
  });
  kinds.push_back({
      .name = "sneak",
      .build = gait(GaitKind::sneak),
      .phrases = {"{sneak} forward", "{creep} forward carefully with lifted arms",
                  "{sneak} ahead with bent knees and careful steps"},
      .actions = {"walk", "sneak"},
      .low_speed = 0.4,
      .high_speed = 0.65,
      .shortest = 4,
      .longest = 8,
  });
  kinds.push_back({
      .name = "march",
      .build = gait(GaitKind::march),
      .phrases = {"{march} forward with high knees", "{march} and {lift} the knees high",
                  "{walk} forward lifting the knees high"},
      .actions = {"walk", "march"},
      .low_speed = 0.7,
      .high_speed = 1.1,
      .shortest = 3.5,
      .longest = 7,
  });
  kinds.push_back({
      .name = "crouch-walk",
      .build = gait(GaitKind::crouch),
      .phrases = {"{walk} forward in a crouch", "{crouch} and {walk} forward",
                  "{move} forward crouched low"},
      .actions = {"walk", "crouch"},
      .low_speed = 0.5,
      .high_speed = 0.9,
      .shortest = 3.5,
      .longest = 7,
  });
  kinds.push_back({
      .name = "step-over",
      .build = gait(GaitKind::step_over),
      .phrases = {"{walk} forward and {step} over an obstacle",
                  "{step} over something while walking",
                  "{walk} ahead and {step} high over an object"},
      .actions = {"walk", "step over"},
      .low_speed = 0.8,
      .high_speed = 1.15,
      .shortest = 4,
      .longest = 6.5,
  });
  kinds.push_back({
      .name = "walk-stop",
      .build = gait(GaitKind::stop),
      .phrases = {"{walk} forward and {stop}", "{walk} forward, then {stand} still",
                  "{walk} ahead and {come} to a halt"},
      .actions = {"walk", "stop", "stand"},
      .low_speed = 0.9,
      .high_speed = 1.4,
      .shortest = 4.5,
      .longest = 8,
      .styles = true,
  });
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{
        .name = "walk-turn",
        .build = gait(GaitKind::turn_after, side),
        .phrases = {"{walk} forward and {turn} [side]", "{walk} ahead, then {turn} to the [side]",
                    "{walk} around a corner to the [side]"},
        .actions = {"walk", "turn", turn_tag(side)},
        .low_speed = 0.85,
        .high_speed = 1.25,
        .shortest = 5,
        .longest = 8,
        .styles = true,
    };
  });
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{
        .name = "walk-wave",
        .build = gait(GaitKind::wave_after, side),
        .phrases = {"{walk} forward and then {wave} with the [side] hand",
                    "{walk} ahead, {stop} and {wave} the [side] hand",
                    "{walk} forward, then {wave} with the [side] arm"},
        .actions = {"walk", "wave"},
        .low_speed = 0.8,
        .high_speed = 1.3,
        .shortest = 6,
        .longest = 9,
    };
  });
  kinds.push_back({
      .name = "jog",
      .build = gait(GaitKind::run),
      .phrases = {"{jog} forward", "{jog} straight ahead", "{run} forward at a slow pace"},
      .actions = {"run", "jog"},
      .low_speed = 1.9,
      .high_speed = 2.5,
      .shortest = 3,
      .longest = 7,
      .styles = true,
  });
  kinds.push_back({
      .name = "run",
      .build = gait(GaitKind::run),
      .phrases = {"{run} forward", "{run} straight ahead", "{run} ahead"},
      .actions = {"run"},
      .low_speed = 2.8,
      .high_speed = 3.6,
      .shortest = 3,
      .longest = 6,
  });
  kinds.push_back({
      .name = "sprint",
      .build = gait(GaitKind::run),
      .phrases = {"{sprint} forward", "{run} very fast", "{sprint} ahead at top speed"},
      .actions = {"run", "sprint"},
      .low_speed = 4.2,
      .high_speed = 4.8,
      .shortest = 3,
      .longest = 4.5,
  });
}

void add_turns_and_stands(ProceduralKinds& kinds) {
  struct TurnWords {
    double degrees;
    const char* name;
    std::vector<std::string> phrases;
  };
  const std::vector<TurnWords> turns = {
      {90,
       "turn-90",
       {"{turn} 90 degrees to the [side]", "{make} a quarter turn to the [side]",
        "{turn} [side] on the spot"}},
      {180,
       "turn-180",
       {"{turn} around to the [side]", "{turn} 180 degrees to the [side]",
        "{make} a half turn to the [side]"}},
      {360,
       "turn-360",
       {"{turn} in a full circle to the [side] on the spot", "{turn} 360 degrees to the [side]",
        "{make} a full turn to the [side]"}}};
  for (const TurnWords& turn : turns) {
    add_sides(kinds, [&](ActionSide side) {
      const double degrees = turn.degrees;
      std::vector<std::string> actions = {"turn", turn_tag(side)};
      if (degrees == 180) actions.emplace_back("turn around");
      return ProceduralKind{
          .name = turn.name,
          .build = [=](const ProceduralParameters& p) { return make_turn(p, side, degrees); },
          .phrases = turn.phrases,
          .actions = actions,
          .styles = true,
      };
    });
  }
  kinds.push_back({
      .name = "stand",
      .build = make_stand,
      .phrases = {"{stand} still", "{stand} in place", "{stand} and {wait}"},
      .actions = {"stand", "idle"},
      .shortest = 2.5,
      .longest = 8,
      .styles = true,
  });
}

}  // namespace

const std::vector<ProceduralKind>& procedural_kind_table() {
  static const ProceduralKinds table = [] {
    ProceduralKinds kinds;
    add_walks(kinds);
    add_turns_and_stands(kinds);
    add_arm_kinds(kinds);
    add_body_kinds(kinds);
    return kinds;
  }();
  return table;
}

}  // namespace remomask::synthetic
