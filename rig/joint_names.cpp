#include "rig/joint_names.h"

#include <algorithm>

namespace remomask::rig {

const std::vector<NamePreset>& name_presets() {
  // Unity's names of human bones and Godot's profile of humanoids are the same words.
  static constexpr std::array<std::string_view, kRigJoints> kHumanoid = {
      "Hips",          "LeftUpperLeg", "RightUpperLeg", "Spine",        "LeftLowerLeg",
      "RightLowerLeg", "Chest",        "LeftFoot",      "RightFoot",    "UpperChest",
      "LeftToes",      "RightToes",    "Neck",          "LeftShoulder", "RightShoulder",
      "Head",          "LeftUpperArm", "RightUpperArm", "LeftLowerArm", "RightLowerArm",
      "LeftHand",      "RightHand"};
  static const std::vector<NamePreset> presets = {
      {JointNames::mixamo,
       "mixamo",
       "Root",
       {"Hips",        "LeftUpLeg",    "RightUpLeg",    "Spine",    "LeftLeg",     "RightLeg",
        "Spine1",      "LeftFoot",     "RightFoot",     "Spine2",   "LeftToeBase", "RightToeBase",
        "Neck",        "LeftShoulder", "RightShoulder", "Head",     "LeftArm",     "RightArm",
        "LeftForeArm", "RightForeArm", "LeftHand",      "RightHand"}},
      {JointNames::unreal,
       "unreal",
       "root",
       {"pelvis",     "thigh_l",    "thigh_r",    "spine_01", "calf_l",     "calf_r",
        "spine_02",   "foot_l",     "foot_r",     "spine_03", "ball_l",     "ball_r",
        "neck_01",    "clavicle_l", "clavicle_r", "head",     "upperarm_l", "upperarm_r",
        "lowerarm_l", "lowerarm_r", "hand_l",     "hand_r"}},
      {JointNames::unity, "unity", "Root", kHumanoid},
      {JointNames::vrm,
       "vrm",
       "root",
       {"hips",          "leftUpperLeg", "rightUpperLeg", "spine",        "leftLowerLeg",
        "rightLowerLeg", "chest",        "leftFoot",      "rightFoot",    "upperChest",
        "leftToes",      "rightToes",    "neck",          "leftShoulder", "rightShoulder",
        "head",          "leftUpperArm", "rightUpperArm", "leftLowerArm", "rightLowerArm",
        "leftHand",      "rightHand"}},
      {JointNames::godot, "godot", "Root", kHumanoid},
      {JointNames::smpl,
       "smpl",
       "root",
       {"pelvis",     "left_hip",      "right_hip",      "spine1",      "left_knee",
        "right_knee", "spine2",        "left_ankle",     "right_ankle", "spine3",
        "left_foot",  "right_foot",    "neck",           "left_collar", "right_collar",
        "head",       "left_shoulder", "right_shoulder", "left_elbow",  "right_elbow",
        "left_wrist", "right_wrist"}}};
  return presets;
}

const NamePreset& name_preset(JointNames names) {
  const std::vector<NamePreset>& all = name_presets();
  return *std::find_if(all.begin(), all.end(),
                       [names](const NamePreset& preset) { return preset.names == names; });
}

const NamePreset* find_name_preset(const std::vector<std::string>& names) {
  const auto has = [&](std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const NamePreset& preset : name_presets()) {
    if (std::all_of(preset.joints.begin(), preset.joints.end(), has)) return &preset;
  }
  return nullptr;
}

}  // namespace remomask::rig
