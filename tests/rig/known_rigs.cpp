#include "tests/rig/known_rigs.h"

namespace remomask::testing_support {

namespace {

RigNames mixamo(const std::string& program, const std::string& prefix) {
  const auto p = [&](const std::string& name) { return prefix + name; };
  return {program,
          {},
          p("Hips"),
          {p("Spine"), p("Spine1"), p("Spine2")},
          {p("Neck")},
          p("Head"),
          {p("{Left|Right}Shoulder")},
          p("{Left|Right}Arm"),
          p("{Left|Right}ForeArm"),
          p("{Left|Right}Hand"),
          p("{Left|Right}UpLeg"),
          p("{Left|Right}Leg"),
          p("{Left|Right}Foot"),
          p("{Left|Right}ToeBase"),
          {p("HeadTop_End") + "<" + p("Head"), p("LeftEye") + "<" + p("Head"),
           p("{Left|Right}Toe_End") + "<" + p("{Left|Right}ToeBase"),
           p("{Left|Right}HandThumb1") + "<" + p("{Left|Right}Hand"),
           p("{Left|Right}HandIndex1") + "<" + p("{Left|Right}Hand")}};
}

RigNames smpl(const std::string& program, const std::string& pelvis, const std::string& before,
              bool capitals) {
  const auto n = [&](const char* lower, const char* upper) {
    return before + (capitals ? upper : lower);
  };
  return {program,
          {},
          pelvis,
          {n("spine1", "Spine1"), n("spine2", "Spine2"), n("spine3", "Spine3")},
          {n("neck", "Neck")},
          n("head", "Head"),
          {n("{left|right}_collar", "{L|R}_Collar")},
          n("{left|right}_shoulder", "{L|R}_Shoulder"),
          n("{left|right}_elbow", "{L|R}_Elbow"),
          n("{left|right}_wrist", "{L|R}_Wrist"),
          n("{left|right}_hip", "{L|R}_Hip"),
          n("{left|right}_knee", "{L|R}_Knee"),
          n("{left|right}_ankle", "{L|R}_Ankle"),
          n("{left|right}_foot", "{L|R}_Foot"),
          {}};
}

RigNames humanoid(const std::string& program, bool capitals, const std::string& prefix = "") {
  const auto n = [&](const char* upper) {
    std::string name = upper;
    if (!capitals) {
      if (name[0] == '{') {
        name = "{left|right}" + name.substr(12);
      } else {
        name[0] = static_cast<char>(name[0] + 32);
      }
    }
    return prefix + name;
  };
  return {program,
          {"Root"},
          n("Hips"),
          {n("Spine"), n("Chest"), n("UpperChest")},
          {n("Neck")},
          n("Head"),
          {n("{Left|Right}Shoulder")},
          n("{Left|Right}UpperArm"),
          n("{Left|Right}LowerArm"),
          n("{Left|Right}Hand"),
          n("{Left|Right}UpperLeg"),
          n("{Left|Right}LowerLeg"),
          n("{Left|Right}Foot"),
          n("{Left|Right}Toes"),
          {}};
}

RigNames biped(const std::string& program, const std::string& prefix) {
  const auto p = [&](const std::string& name) { return prefix + name; };
  const std::string s = prefix.substr(prefix.size() - 1);  // blank or underscore
  const auto limb = [&](const std::string& name) { return prefix + "{L|R}" + s + name; };
  return {program,
          {prefix.substr(0, prefix.size() - 1)},
          p("Pelvis"),
          {p("Spine"), p("Spine1"), p("Spine2"), p("Spine3")},
          {p("Neck")},
          p("Head"),
          {limb("Clavicle")},
          limb("UpperArm"),
          limb("Forearm"),
          limb("Hand"),
          limb("Thigh"),
          limb("Calf"),
          limb("Foot"),
          limb("Toe0"),
          {p("HeadNub") + "<" + p("Head"), limb("Finger0") + "<" + limb("Hand"),
           limb("ForeTwist") + "<" + limb("Forearm"), limb("Toe0Nub") + "<" + limb("Toe0"),
           p("Footsteps") + "<" + p("Pelvis")}};
}

RigNames rigify(const std::string& program, const std::string& p, bool segments) {
  RigNames names = {program,
                    {"root"},
                    p + "spine",
                    {p + "spine.001", p + "spine.002", p + "spine.003"},
                    {p + "spine.004", p + "spine.005"},
                    p + "spine.006",
                    {p + "shoulder.{L|R}"},
                    p + "upper_arm.{L|R}",
                    p + "forearm.{L|R}",
                    p + "hand.{L|R}",
                    p + "thigh.{L|R}",
                    p + "shin.{L|R}",
                    p + "foot.{L|R}",
                    p + "toe.{L|R}",
                    {p + "pelvis.{L|R}<" + p + "spine", p + "breast.{L|R}<" + p + "spine.003",
                     p + "f_index.01.{L|R}<" + p + "hand.{L|R}"}};
  if (segments) {
    names.others.push_back(p + "thigh.{L|R}.001<" + p + "thigh.{L|R}");
    names.others.push_back(p + "upper_arm.{L|R}.001<" + p + "upper_arm.{L|R}");
  }
  return names;
}

std::vector<RigNames> make_rigs() {
  std::vector<RigNames> rigs = {
      mixamo("Mixamo", "mixamorig:"),
      mixamo("Mixamo, numbered", "mixamorig1:"),
      mixamo("Mixamo, underscore", "mixamorig_"),
      mixamo("Mixamo without its colon", "mixamorig"),
      mixamo("Perception Neuron", "Robot_"),
      mixamo("HumanIK", "Character1_"),
      mixamo("a name space of two levels", "Armature|Hero:"),
      smpl("SMPL", "Pelvis", "", true),
      smpl("SMPL, lower case", "pelvis", "", false),
      smpl("SMPL of its FBX files", "m_avg_Pelvis", "m_avg_", true),
      humanoid("Unity", true),
      humanoid("Godot", true),
      humanoid("VRM", false),
      biped("Biped", "Bip01 "),
      biped("Biped, Bip001", "Bip001_"),
      biped("Valve", "ValveBiped.Bip01_"),
      rigify("Rigify, deforming bones", "DEF-", true),
      rigify("Rigify, original bones", "ORG-", false),
      rigify("Rigify, metarig", "", false),
      mixamo("iClone, renamed", "RL_"),
  };
  RigNames smplx = smpl("SMPL-X", "pelvis", "", false);
  smplx.others = {"jaw<head", "{left|right}_eye_smplhf<head",
                  "{left|right}_index1<{left|right}_wrist"};
  rigs.push_back(smplx);
  const std::vector<RigNames> more = rigs_of_captures_and_games();
  rigs.insert(rigs.end(), more.begin(), more.end());

  return rigs;
}

}  // namespace

const std::vector<RigNames>& known_rigs() {
  static const std::vector<RigNames> rigs = make_rigs();
  return rigs;
}

}  // namespace remomask::testing_support
