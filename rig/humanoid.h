#pragma once

#include <array>
#include <string>
#include <vector>

#include "rig/skeleton_view.h"

namespace remomask::rig {

/// Joints of one leg or arm from the body outwards; -1 where the skeleton has none.
/// Legs: hip, knee, ankle, toe. Arms: collar, shoulder, elbow, wrist.
using LimbJoints = std::array<int, 4>;
enum LegJoint { kHip, kKnee, kAnkle, kToe };
enum ArmJoint { kCollar, kShoulder, kElbow, kWrist };

/// A skeleton's joints that play the parts of a human body. Left is 0, right is 1.
struct Humanoid {
  std::array<LimbJoints, 2> legs = {{{-1, -1, -1, -1}, {-1, -1, -1, -1}}};
  std::array<LimbJoints, 2> arms = {{{-1, -1, -1, -1}, {-1, -1, -1, -1}}};
  int pelvis = -1;
  std::vector<int> spine;  ///< from the pelvis to the neck, without either; may be empty
  int neck = -1;           ///< may be absent
  int head = -1;           ///< may be absent
  bool by_names = true;    ///< false: names said nothing, shape and hierarchy decided
};

/// A joint that is there as an index.
inline size_t at(int joint) { return static_cast<size_t>(joint); }

/// What is absent without which there is no body: "left knee", ...; empty if all is there.
std::vector<std::string> missing_parts(const Humanoid& body);

/// Lowest joint above both (or one of them); -1 if they hang under different roots.
int common_ancestor(const SkeletonView& skeleton, int a, int b);

/// Whether `above` is `joint` or above it.
bool is_above(const SkeletonView& skeleton, int above, int joint);

}  // namespace remomask::rig
