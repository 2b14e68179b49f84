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
    kinds.push_back({
        .name = "wave-" + word,
        .side = name_side,
        .build = [=](const ProceduralParameters& p) { return make_wave(p, side); },
        .phrases = {"{wave} with " + hand, "{raise} " + arm + " and {wave}", "{wave} " + hand},
        .actions = {"wave"},
        .shortest = 2.8,
        .longest = 6,
        .styles = true,
    });
    kinds.push_back({
        .name = "raise-" + word,
        .side = name_side,
        .build = [=](const ProceduralParameters& p) { return make_raise(p, side); },
        .phrases = {"{raise} " + arm + " and {lower} " + (both ? "them" : "it") + " again",
                    "{lift} " + arm + " above the head and {bring} " + (both ? "them" : "it") +
                        " down",
                    "{raise} " + hand + " up high and {let} " + (both ? "them" : "it") + " down"},
        .actions = {"raise hand"},
        .shortest = 2.6,
        .longest = 5.5,
        .styles = true,
    });
  }
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{
        .name = "point",
        .build = [=](const ProceduralParameters& p) { return make_point(p, side); },
        .phrases = {"{point} forward with the [side] hand",
                    "{point} straight ahead with the [side] arm",
                    "{stretch} out the [side] arm to point ahead"},
        .actions = {"point"},
        .shortest = 2.4,
        .longest = 4.5,
    };
  });
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{
        .name = "throw",
        .build = [=](const ProceduralParameters& p) { return make_throw(p, side); },
        .phrases = {"{throw} something with the [side] hand",
                    "{throw} an object forward with the [side] arm",
                    "{draw} back the [side] arm and {throw}"},
        .actions = {"throw"},
    };
  });
  add_sides(kinds, [](ActionSide side) {
    return ProceduralKind{
        .name = "punch",
        .build = [=](const ProceduralParameters& p) { return make_punch(p, side, false); },
        .phrases = {"{punch} with the [side] fist [times]", "{throw} [n] [side] punch[es]",
                    "{punch} forward [times] with the [side] hand"},
        .actions = {"punch", "fight"},
        .most = 4,
    };
  });
  kinds.push_back({
      .name = "punch-combination",
      .build = [](const ProceduralParameters& p) { return make_punch(p, ActionSide::left, true); },
      .phrases = {"{punch} with both fists in turn, [times] in all",
                  "{box} with alternating fists, [n] punch[es] in all",
                  "{throw} [n] punch[es], left and right in turn"},
      .actions = {"box", "punch", "fight"},
      .most = 6,
  });
  kinds.push_back({
      .name = "clap",
      .build = make_clap,
      .phrases = {"{clap} [times]", "{clap} the hands [times]",
                  "{clap} both hands together [times]"},
      .actions = {"clap"},
      .most = 6,
  });
  kinds.push_back({
      .name = "stretch",
      .build = make_stretch,
      .phrases = {"{stretch} both arms overhead",
                  "{stretch} the arms up and {lean} from side to side",
                  "{reach} up with both arms to stretch"},
      .actions = {"stretch", "exercise"},
      .shortest = 4,
      .longest = 8,
  });
}

void add_body_kinds(ProceduralKinds& kinds) {
  const auto jump = [](double height, double distance) {
    return [=](const ProceduralParameters& p) { return make_jump(p, height, distance); };
  };
  kinds.push_back({
      .name = "jump-small",
      .build = jump(0.12, 0),
      .phrases = {"{make} [n] small jump[s] in place", "{jump} up a little [times]",
                  "{hop} a little [times] on the spot"},
      .actions = {"jump"},
      .most = 3,
  });
  kinds.push_back({
      .name = "jump-high",
      .build = jump(0.34, 0),
      .phrases = {"{jump} high into the air [times]", "{jump} up high [times]",
                  "{make} [n] high jump[s] in place"},
      .actions = {"jump", "jump high"},
      .most = 2,
  });
  kinds.push_back({
      .name = "jump-forward",
      .build = jump(0.18, 0.9),
      .phrases = {"{jump} forward [times]", "{make} [n] jump[s] forward",
                  "{leap} forward [times] with both feet"},
      .actions = {"jump", "jump forward"},
      .most = 3,
  });
  kinds.push_back({
      .name = "jumping-jacks",
      .build = make_jumping_jacks,
      .phrases = {"{do} [n] jumping jack[s]", "{perform} [n] jumping jack[s]",
                  "{jump} with spread arms and legs, [n] jumping jack[s]"},
      .actions = {"jumping jacks", "exercise", "jump"},
      .most = 6,
  });
  kinds.push_back({
      .name = "squat",
      .build = make_squat,
      .phrases = {"{squat} [times]", "{do} [n] squat[s]",
                  "{squat} down and {come} back up [times]"},
      .actions = {"squat", "exercise"},
      .most = 3,
      .styles = true,
  });
  for (const bool sideways : {false, true}) {
    add_sides(kinds, [&](ActionSide side) {
      const std::string where = sideways ? "to the side" : "forward";
      return ProceduralKind{
          .name = sideways ? "kick-side" : "kick-front",
          .build = [=](const ProceduralParameters& p) { return make_kick(p, side, sideways); },
          .phrases = {"{kick} " + where + " with the [side] leg [times]",
                      "{kick} the [side] foot " + where + " [times]",
                      "{make} [n] kick[s] " + where + " with the [side] foot"},
          .actions = {"kick", "fight", sideways ? "side kick" : "front kick"},
          .most = 3,
      };
    });
  }
  kinds.push_back({
      .name = "bow-slight",
      .build = [](const ProceduralParameters& p) { return make_bow(p, 28); },
      .phrases = {"{bow} slightly [times]", "{make} [n] slight bow[s]",
                  "{lean} forward slightly [times] to bow"},
      .actions = {"bow"},
      .most = 2,
  });
  kinds.push_back({
      .name = "bow-deep",
      .build = [](const ProceduralParameters& p) { return make_bow(p, 82); },
      .phrases = {"{bow} deeply [times]", "{make} [n] deep bow[s]",
                  "{bend} far forward [times] to bow"},
      .actions = {"bow"},
      .most = 2,
  });
  kinds.push_back({
      .name = "sit-down",
      .build = [](const ProceduralParameters& p) { return make_sit(p, false); },
      .phrases = {"{sit} down", "{sit} down on a chair", "{take} a seat"},
      .actions = {"sit", "sit down"},
      .shortest = 3,
      .longest = 5,
      .styles = true,
  });
  kinds.push_back({
      .name = "sit-stand",
      .build = [](const ProceduralParameters& p) { return make_sit(p, true); },
      .phrases = {"{sit} down and {stand} up again", "{sit} on a chair, then {stand} up",
                  "{take} a seat and {get} back up"},
      .actions = {"sit", "sit down", "stand up"},
      .shortest = 5.2,
      .longest = 8,
      .styles = true,
  });
  kinds.push_back({
      .name = "sway",
      .build = make_sway,
      .phrases = {"{dance} by swaying from side to side",
                  "{sway} to the left and right like a dancer",
                  "{dance} on the spot with swaying hips"},
      .actions = {"dance", "sway"},
      .shortest = 4,
      .longest = 9,
  });
}

}  // namespace remomask::synthetic
