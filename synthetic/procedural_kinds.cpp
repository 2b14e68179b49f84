#include "synthetic/procedural_kinds.h"

namespace remomask::synthetic {

namespace {

std::function<Poses(const ProceduralParameters&)> gait(GaitKind kind,
                                                       ActionSide side = ActionSide::both) {
  return [=](const ProceduralParameters& p) { return make_gait(p, kind, side); };
}

void add_walks(ProceduralKinds& kinds) {
  kinds.push_back({"walk-forward",
                   "",
                   gait(GaitKind::walk),
                   {"{walk} forward", "{walk} straight ahead", "{take} steps forward"},
                   {"walk"},
                   0.95,
                   1.4,
                   3.5,
                   8,
                   1,
                   true});
  kinds.push_back(
      {"walk-slow",
       "",
       gait(GaitKind::walk),
       {"slowly {walk} forward", "{walk} forward at a slow pace", "{walk} ahead slowly"},
       {"walk"},
       0.5,
       0.75,
       4,
       9,
       1,
       false});
  kinds.push_back({"walk-fast",
                   "",
                   gait(GaitKind::walk),
                   {"{walk} forward quickly", "{walk} forward at a brisk pace", "{walk} fast"},
                   {"walk"},
                   1.55,
                   1.85,
                   3,
                   6,
                   1,
                   false});
  kinds.push_back({"walk-backward",
                   "",
                   gait(GaitKind::backward),
                   {"{walk} backward", "{walk} backwards", "{take} steps backward"},
                   {"walk"},
                   0.5,
                   0.9,
                   3,
                   7,
                   1,
                   true});
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{"walk-sideways",
                          "",
                          gait(GaitKind::sideways, side),
                          {"{walk} sideways to the [side]", "{sidestep} to the [side]",
                           "{step} sideways to the [side]"},
                          {"walk", "sidestep"},
                          0.3,
                          0.55,
                          3,
                          6,
                          1,
                          false};
  });
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{
        "walk-circle",
        "",
        gait(GaitKind::circle, side),
        {"{walk} in a circle to the [side]", "{walk} in a full circle, turning [side]",
         "{walk} around in a circle towards the [side]"},
        {"walk", "circle"},
        0.8,
        1.25,
        6.5,
        9,
        1,
        true};
  });
  kinds.push_back(
      {"tiptoe",
       "",
       gait(GaitKind::tiptoe),
       {"{walk} forward on tiptoe", "{tiptoe} forward", "{walk} on the balls of the feet"},
       {"walk", "tiptoe"},
       0.5,
       0.85,
       3.5,
       7,
       1,
       false});
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{
        "limp",
        "",
        gait(GaitKind::limp, side),
        {"{limp} forward with a hurt [side] leg", "{walk} with a limp of the [side] leg",
         "{limp} forward, favoring the injured [side] leg"},
        {"walk", "limp"},
        0.5,
        0.8,
        4,
        8,
        1,
        false};
  });
  kinds.push_back({"sneak",
                   "",
                   gait(GaitKind::sneak),
                   {"{sneak} forward", "{creep} forward carefully with lifted arms",
                    "{sneak} ahead with bent knees and careful steps"},
                   {"walk", "sneak"},
                   0.4,
                   0.65,
                   4,
                   8,
                   1,
                   false});
  kinds.push_back({"march",
                   "",
                   gait(GaitKind::march),
                   {"{march} forward with high knees", "{march} and {lift} the knees high",
                    "{walk} forward lifting the knees high"},
                   {"walk", "march"},
                   0.7,
                   1.1,
                   3.5,
                   7,
                   1,
                   false});
  kinds.push_back(
      {"crouch-walk",
       "",
       gait(GaitKind::crouch),
       {"{walk} forward in a crouch", "{crouch} and {walk} forward", "{move} forward crouched low"},
       {"walk", "crouch"},
       0.5,
       0.9,
       3.5,
       7,
       1,
       false});
  kinds.push_back(
      {"step-over",
       "",
       gait(GaitKind::step_over),
       {"{walk} forward and {step} over an obstacle", "{step} over something while walking",
        "{walk} ahead and {step} high over an object"},
       {"walk", "step over"},
       0.8,
       1.15,
       4,
       6.5,
       1,
       false});
  kinds.push_back({"walk-stop",
                   "",
                   gait(GaitKind::stop),
                   {"{walk} forward and {stop}", "{walk} forward, then {stand} still",
                    "{walk} ahead and {come} to a halt"},
                   {"walk", "stand"},
                   0.9,
                   1.4,
                   4.5,
                   8,
                   1,
                   true});
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{
        "walk-turn",
        "",
        gait(GaitKind::turn_after, side),
        {"{walk} forward and {turn} [side]", "{walk} ahead, then {turn} to the [side]",
         "{walk} around a corner to the [side]"},
        {"walk", "turn"},
        0.85,
        1.25,
        5,
        8,
        1,
        true};
  });
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{"walk-wave",
                          "",
                          gait(GaitKind::wave_after, side),
                          {"{walk} forward and then {wave} with the [side] hand",
                           "{walk} ahead, {stop} and {wave} the [side] hand",
                           "{walk} forward, then {wave} with the [side] arm"},
                          {"walk", "wave"},
                          0.8,
                          1.3,
                          6,
                          9,
                          1,
                          false};
  });
  kinds.push_back({"jog",
                   "",
                   gait(GaitKind::run),
                   {"{jog} forward", "{jog} straight ahead", "{run} forward at a slow pace"},
                   {"run", "jog"},
                   1.9,
                   2.5,
                   3,
                   7,
                   1,
                   true});
  kinds.push_back({"run",
                   "",
                   gait(GaitKind::run),
                   {"{run} forward", "{run} straight ahead", "{run} ahead"},
                   {"run"},
                   2.8,
                   3.6,
                   3,
                   6,
                   1,
                   false});
  kinds.push_back({"sprint",
                   "",
                   gait(GaitKind::run),
                   {"{sprint} forward", "{run} very fast", "{sprint} ahead at top speed"},
                   {"run", "sprint"},
                   4.2,
                   4.8,
                   3,
                   4.5,
                   1,
                   false});
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
      return ProceduralKind{
          turn.name,
          "",
          [=](const ProceduralParameters& p) { return make_turn(p, side, degrees); },
          turn.phrases,
          {"turn"},
          0,
          0,
          0,
          0,
          1,
          true};
    });
  }
  kinds.push_back({"stand",
                   "",
                   make_stand,
                   {"{stand} still", "{stand} in place", "{stand} and {wait}"},
                   {"stand"},
                   0,
                   0,
                   2.5,
                   8,
                   1,
                   true});
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
