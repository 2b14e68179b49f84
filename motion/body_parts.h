#pragma once

#include <array>
#include <vector>

#include "remomask/skeleton.h"

namespace remomask::motion {

inline constexpr int kBodyParts = 6;
inline constexpr int kPartSlots = 4;
inline constexpr int kRootSlot = -1;  ///< root channels 0..3 and the four contacts
inline constexpr int kFreeSlot = -2;  ///< no channel

/// A frame as a map of 6 body parts x 4 slots: left leg, right leg, root and lower spine, upper
/// spine and head, left arm, right arm. Every joint has exactly one slot. Each row of the
/// tokenizer's map is one of these parts.
struct BodyPartMap {
  std::array<std::array<int, kPartSlots>, kBodyParts> slots;  ///< joint, kRootSlot or kFreeSlot
  std::array<const char*, kBodyParts> names;                  ///< "left_leg", ...
};

/// Throws Error for a skeleton other than humanml3d and kit.
const BodyPartMap& body_parts(const Skeleton& skeleton);

/// The body part of every joint.
std::vector<int> joint_parts(const Skeleton& skeleton);

/// Feature columns of a part, slot by slot: for a joint its position (3), rotation (6) and velocity
/// (3), for the root joint its velocity only, and for the root slot columns 0..3. The contacts come
/// last in the leg that they belong to. Each of the 12 J - 1 columns belongs to exactly one part.
std::vector<int> part_columns(const Skeleton& skeleton, int part);

}  // namespace remomask::motion
