// Kinds of motion on the spot: their builders and words.
#include "synthetic/procedural_kinds.h"

namespace remomask::synthetic {

void add_arm_kinds(ProceduralKinds& kinds) {
  for (ActionSide side : {ActionSide::left, ActionSide::right, ActionSide::both}) {
    const bool both = side == ActionSide::both;
    const std::string word = side == ActionSide::left ? "left" : both ? "both" : "right";
    const std::string hand = both ? "both hands" : "the " + word + " hand";
    const std::string arm = both ? "both arms" : "the " + word + " arm";
    const std::string name_side = both ? "" : word;
    kinds.push_back({"wave-" + word,
                     name_side,
                     [=](const ProceduralParameters& p) { return make_wave(p, side); },
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
         [=](const ProceduralParameters& p) { return make_raise(p, side); },
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
        [=](const ProceduralParameters& p) { return make_point(p, side); },
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
        [=](const ProceduralParameters& p) { return make_throw(p, side); },
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
                          [=](const ProceduralParameters& p) { return make_punch(p, side, false); },
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
  kinds.push_back(
      {"punch-combination",
       "",
       [](const ProceduralParameters& p) { return make_punch(p, ActionSide::left, true); },
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

void add_body_kinds(ProceduralKinds& kinds) {
  const auto jump = [](double height, double distance) {
    return [=](const ProceduralParameters& p) { return make_jump(p, height, distance); };
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
      return ProceduralKind{
          sideways ? "kick-side" : "kick-front",
          "",
          [=](const ProceduralParameters& p) { return make_kick(p, side, sideways); },
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
                   [](const ProceduralParameters& p) { return make_bow(p, 28); },
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
       [](const ProceduralParameters& p) { return make_bow(p, 82); },
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
                   [](const ProceduralParameters& p) { return make_sit(p, false); },
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
                   [](const ProceduralParameters& p) { return make_sit(p, true); },
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

}  // namespace remomask::synthetic
