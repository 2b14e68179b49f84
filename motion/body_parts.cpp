#include "motion/body_parts.h"

#include "remomask/error.h"

namespace remomask::motion {

namespace {

constexpr std::array<const char*, kBodyParts> kBodyPartNames = {
    "left_leg", "right_leg", "root_lower_spine", "upper_spine_head", "left_arm", "right_arm"};

constexpr BodyPartMap kHumanmlParts = {{{{1, 4, 7, 10},
                                         {2, 5, 8, 11},
                                         {kRootSlot, 0, 3, 6},
                                         {9, 12, 15, kFreeSlot},
                                         {13, 16, 18, 20},
                                         {14, 17, 19, 21}}},
                                       kBodyPartNames};

constexpr BodyPartMap kKitParts = {{{{17, 18, 19, 20},
                                     {12, 13, 14, 15},
                                     {kRootSlot, 0, 11, 16},
                                     {1, 2, 3, 4},
                                     {8, 9, 10, kFreeSlot},
                                     {5, 6, 7, kFreeSlot}}},
                                   kBodyPartNames};

}  // namespace

const BodyPartMap& body_parts(const Skeleton& skeleton) {
  if (skeleton.joints() == humanml_skeleton().joints()) return kHumanmlParts;
  if (skeleton.joints() == kit_skeleton().joints()) return kKitParts;
  throw Error("no body parts are defined for the skeleton \"" + skeleton.name +
              "\"; use humanml3d or kit");
}

std::vector<int> joint_parts(const Skeleton& skeleton) {
  std::vector<int> result(skeleton.joints(), 0);
  for (int part = 0; part < kBodyParts; ++part) {
    for (const int slot : body_parts(skeleton).slots[part]) {
      if (slot >= 0) result[slot] = part;
    }
  }
  return result;
}

std::vector<int> part_columns(const Skeleton& skeleton, int part) {
  const int joints = skeleton.joints();
  const int rotations = 4 + 3 * (joints - 1), velocities = rotations + 6 * (joints - 1);
  const int contacts = velocities + 3 * joints;
  std::vector<int> columns;
  const auto add_range = [&](int first, int count) {
    for (int i = 0; i < count; ++i) columns.push_back(first + i);
  };
  for (const int slot : body_parts(skeleton).slots[part]) {
    if (slot == kFreeSlot) continue;
    if (slot == kRootSlot) {
      add_range(0, 4);
      continue;
    }
    if (slot > 0) {
      add_range(4 + 3 * (slot - 1), 3);
      add_range(rotations + 6 * (slot - 1), 6);
    }
    add_range(velocities + 3 * slot, 3);
  }
  if (part == 0) add_range(contacts, 2);
  if (part == 1) add_range(contacts + 2, 2);
  return columns;
}

}  // namespace remomask::motion
