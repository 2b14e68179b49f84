#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace remomask::rig {

enum class Side { none, left, right };

/// The part of a body that a joint's name speaks of. Several words name two things, depending on
/// the rig: `shoulder` is a collar bone or an upper arm, `hip` a thigh or what leads to it, `leg` a
/// thigh or a shin, `foot` an ankle or toes. What they mean is settled by the hierarchy.
enum class BodyPart {
  none,
  root,
  pelvis,
  spine,
  neck,
  head,
  hip,
  thigh,
  leg,
  shin,
  ankle,
  foot,
  heel,
  toe,
  collar,
  shoulder,
  upper_arm,
  arm,
  forearm,
  wrist,
  hand
};

/// What a joint's name says.
struct NameReading {
  Side side = Side::none;
  BodyPart part = BodyPart::none;
  int number = -1;         ///< that follows the words, as in "spine_02"
  int strange_words = 0;   ///< words that neither name a body part nor are common to the rig
  bool helper = false;     ///< twist, IK, finger, face, hair, cloth, prop: never one of ours
  bool end = false;        ///< only marks where a bone ends: "HeadTop_End", "Nub"
  bool connector = false;  ///< leads to a limb: "LHipJoint", "lButtock"
  bool tail = false;       ///< an animal's, or a costume's
};

/// Reads all names of a skeleton: what most of them share says nothing about a single one.
std::vector<NameReading> read_joint_names(const std::vector<std::string>& names);

/// Lower-case words and numbers of a name: "mixamorig:LeftUpLeg" is left, up, leg. Namespaces are
/// cut off, words written together are taken apart ("lfemur"), and common Japanese and Chinese
/// names are translated.
std::vector<std::string> words_of_name(std::string_view name);

}  // namespace remomask::rig
