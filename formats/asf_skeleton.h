#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "motion/vector.h"

namespace remomask::formats {

/// What a column of an .amc line does to its bone.
enum class AsfChannel { rotate_x, rotate_y, rotate_z, move_x, move_y, move_z, stretch };

/// A bone of an .asf file; the root is the first.
struct AsfBone {
  std::string name;
  int parent = -1;
  Vec3 tip = Vec3::Zero();       ///< from the start of the bone, in the file's unit and axes
  Quat axes = Quat::Identity();  ///< of its rotations
  std::vector<AsfChannel> channels;
};

struct AsfSkeleton {
  std::vector<AsfBone> bones;                    ///< parents come before their children
  std::unordered_map<std::string, int> numbers;  ///< of the bones by name
  Vec3 position = Vec3::Zero();                  ///< of the root
  bool degrees = true;     ///< unit of angles in this file and, unless it says so, in the .amc
  double length_unit = 1;  ///< of the line "length": CMU's 0.45 is that of 0.45 units an inch
};

/// Reads the text of an .asf file. Throws FileError with the line.
AsfSkeleton parse_asf(std::string_view text, const std::string& path);

/// Rotation about an axis of the channel (rotate_x and so on) by an angle in radians.
Quat asf_rotation(AsfChannel channel, double angle);

}  // namespace remomask::formats
