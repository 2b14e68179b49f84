#pragma once

#include <string>
#include <vector>

#include "motion/vector.h"
#include "remomask/motion.h"

namespace remomask::drawing {

/// A file's skeleton and the 22 joints that were found in it; metres, Y up, left at +X.
struct SkeletonPicture {
  std::string title, subtitle;
  std::vector<Vec3> joints;         ///< of the file
  std::vector<int> parents;         ///< -1 for a root
  Motion ours;                      ///< one frame
  std::vector<std::string> labels;  ///< what each of the 22 was found at
};

/// Writes a PNG: the file's bones in grey, ours over them, seen from the front and from the side,
/// every joint of ours with its name and its label.
void write_skeleton_picture(const std::string& png_path, const SkeletonPicture& picture);

}  // namespace remomask::drawing
