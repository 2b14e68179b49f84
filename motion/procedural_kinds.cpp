#include "motion/procedural_kinds.h"

namespace remomask {

namespace {

using Parameters = ProceduralParameters;
using Kinds = std::vector<ProceduralKind>;

/// Adds the kind for every side in turn, with the side at the end of its name.
template <class MakeKind>
void add_sides(Kinds& kinds, MakeKind&& make) {
  for (ActionSide side : {ActionSide::left, ActionSide::right}) {
    ProceduralKind kind = make(side);
    kind.side = side == ActionSide::left ? "left" : "right";
    kind.name += "-" + kind.side;
    kinds.push_back(std::move(kind));
  }
}

std::function<Poses(const Parameters&)> gait(GaitKind kind, ActionSide side = ActionSide::both) {
  return [=](const Parameters& p) { return make_gait(p, kind, side); };
}

void add_walks(Kinds& kinds) {
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

void add_turns_and_stands(Kinds& kinds) {
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
      return ProceduralKind{turn.name,
                            "",
                            [=](const Parameters& p) { return make_turn(p, side, degrees); },
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

void add_arm_actions(Kinds& kinds) {
  for (ActionSide side : {ActionSide::left, ActionSide::right, ActionSide::both}) {
    const bool both = side == ActionSide::both;
    const std::string word = side == ActionSide::left ? "left" : both ? "both" : "right";
    const std::string hand = both ? "both hands" : "the " + word + " hand";
    const std::string arm = both ? "both arms" : "the " + word + " arm";
    const std::string name_side = both ? "" : word;
    kinds.push_back({"wave-" + word,
                     name_side,
                     [=](const Parameters& p) { return make_wave(p, side); },
                     {"{wave} with " + hand, "{raise} " + arm + " and {wave}", "{wave} " + hand},
                     {"wave"},
                     0,
                     0,
                     2.8,
                     6,
                     1,
                     true});
    kinds.push_back(
        {"raise-" + word,
         name_side,
         [=](const Parameters& p) { return make_raise(p, side); },
         {"{raise} " + arm + " and {lower} " + (both ? "them" : "it") + " again",
          "{lift} " + arm + " above the head and {bring} " + (both ? "them" : "it") + " down",
          "{raise} " + hand + " up high and {let} " + (both ? "them" : "it") + " down"},
         {"raise arm"},
         0,
         0,
         2.6,
         5.5,
         1,
         true});
  }
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{
        "point",
        "",
        [=](const Parameters& p) { return make_point(p, side); },
        {"{point} forward with the [side] hand", "{point} straight ahead with the [side] arm",
         "{stretch} out the [side] arm to point ahead"},
        {"point"},
        0,
        0,
        2.4,
        4.5,
        1,
        false};
  });
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{
        "throw",
        "",
        [=](const Parameters& p) { return make_throw(p, side); },
        {"{throw} something with the [side] hand", "{throw} an object forward with the [side] arm",
         "{draw} back the [side] arm and {throw}"},
        {"throw"},
        0,
        0,
        0,
        0,
        1,
        false};
  });
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{"punch",
                          "",
                          [=](const Parameters& p) { return make_punch(p, side, false); },
                          {"{punch} with the [side] fist [times]", "{throw} [n] [side] punch[es]",
                           "{punch} forward [times] with the [side] hand"},
                          {"punch"},
                          0,
                          0,
                          0,
                          0,
                          4,
                          false};
  });
  kinds.push_back({"punch-combination",
                   "",
                   [](const Parameters& p) { return make_punch(p, ActionSide::left, true); },
                   {"{punch} with both fists in turn, [times] in all",
                    "{box} with alternating fists, [n] punch[es] in all",
                    "{throw} [n] punch[es], left and right in turn"},
                   {"punch"},
                   0,
                   0,
                   0,
                   0,
                   6,
                   false});
  kinds.push_back(
      {"clap",
       "",
       make_clap,
       {"{clap} [times]", "{clap} the hands [times]", "{clap} both hands together [times]"},
       {"clap"},
       0,
       0,
       0,
       0,
       6,
       false});
  kinds.push_back(
      {"stretch",
       "",
       make_stretch,
       {"{stretch} both arms overhead", "{stretch} the arms up and {lean} from side to side",
        "{reach} up with both arms to stretch"},
       {"stretch"},
       0,
       0,
       4,
       8,
       1,
       false});
}

void add_body_actions(Kinds& kinds) {
  const auto jump = [](double height, double distance) {
    return [=](const Parameters& p) { return make_jump(p, height, distance); };
  };
  kinds.push_back({"jump-small",
                   "",
                   jump(0.12, 0),
                   {"{make} [n] small jump[s] in place", "{jump} up a little [times]",
                    "{hop} a little [times] on the spot"},
                   {"jump"},
                   0,
                   0,
                   0,
                   0,
                   3,
                   false});
  kinds.push_back({"jump-high",
                   "",
                   jump(0.34, 0),
                   {"{jump} high into the air [times]", "{jump} up high [times]",
                    "{make} [n] high jump[s] in place"},
                   {"jump"},
                   0,
                   0,
                   0,
                   0,
                   2,
                   false});
  kinds.push_back({"jump-forward",
                   "",
                   jump(0.18, 0.9),
                   {"{jump} forward [times]", "{make} [n] jump[s] forward",
                    "{leap} forward [times] with both feet"},
                   {"jump"},
                   0,
                   0,
                   0,
                   0,
                   3,
                   false});
  kinds.push_back({"jumping-jacks",
                   "",
                   make_jumping_jacks,
                   {"{do} [n] jumping jack[s]", "{perform} [n] jumping jack[s]",
                    "{jump} with spread arms and legs, [n] jumping jack[s]"},
                   {"jump", "jumping jack"},
                   0,
                   0,
                   0,
                   0,
                   6,
                   false});
  kinds.push_back(
      {"squat",
       "",
       make_squat,
       {"{squat} [times]", "{do} [n] squat[s]", "{squat} down and {come} back up [times]"},
       {"squat"},
       0,
       0,
       0,
       0,
       3,
       true});
  for (const bool sideways : {false, true}) {
    add_sides(kinds, [&](ActionSide side) {
      const std::string where = sideways ? "to the side" : "forward";
      return ProceduralKind{sideways ? "kick-side" : "kick-front",
                            "",
                            [=](const Parameters& p) { return make_kick(p, side, sideways); },
                            {"{kick} " + where + " with the [side] leg [times]",
                             "{kick} the [side] foot " + where + " [times]",
                             "{make} [n] kick[s] " + where + " with the [side] foot"},
                            {"kick"},
                            0,
                            0,
                            0,
                            0,
                            3,
                            false};
    });
  }
  kinds.push_back({"bow-slight",
                   "",
                   [](const Parameters& p) { return make_bow(p, 28); },
                   {"{bow} slightly [times]", "{make} [n] slight bow[s]",
                    "{lean} forward slightly [times] to bow"},
                   {"bow"},
                   0,
                   0,
                   0,
                   0,
                   2,
                   false});
  kinds.push_back(
      {"bow-deep",
       "",
       [](const Parameters& p) { return make_bow(p, 82); },
       {"{bow} deeply [times]", "{make} [n] deep bow[s]", "{bend} far forward [times] to bow"},
       {"bow"},
       0,
       0,
       0,
       0,
       2,
       false});
  kinds.push_back({"sit-down",
                   "",
                   [](const Parameters& p) { return make_sit(p, false); },
                   {"{sit} down", "{sit} down on a chair", "{take} a seat"},
                   {"sit"},
                   0,
                   0,
                   3,
                   5,
                   1,
                   true});
  kinds.push_back({"sit-stand",
                   "",
                   [](const Parameters& p) { return make_sit(p, true); },
                   {"{sit} down and {stand} up again", "{sit} on a chair, then {stand} up",
                    "{take} a seat and {get} back up"},
                   {"sit", "stand up"},
                   0,
                   0,
                   5.2,
                   8,
                   1,
                   true});
  kinds.push_back(
      {"sway",
       "",
       make_sway,
       {"{dance} by swaying from side to side", "{sway} to the left and right like a dancer",
        "{dance} on the spot with swaying hips"},
       {"dance", "sway"},
       0,
       0,
       4,
       9,
       1,
       false});
}

}  // namespace

const std::vector<ProceduralKind>& procedural_kind_table() {
  static const Kinds table = [] {
    Kinds kinds;
    add_walks(kinds);
    add_turns_and_stands(kinds);
    add_arm_actions(kinds);
    add_body_actions(kinds);
    return kinds;
  }();
  return table;
}

}  // namespace remomask
