#include "rig/humanoid.h"

#include <algorithm>

namespace remomask::rig {

std::vector<std::string> missing_parts(const Humanoid& body) {
  std::vector<std::string> missing;
  if (body.pelvis < 0) missing.emplace_back("pelvis");
  for (size_t side = 0; side < 2; ++side) {
    const std::string name = side == 0 ? "left " : "right ";
    if (body.legs[side][kHip] < 0) missing.push_back(name + "thigh");
    if (body.legs[side][kKnee] < 0) missing.push_back(name + "knee");
    if (body.legs[side][kAnkle] < 0) missing.push_back(name + "ankle");
    if (body.arms[side][kShoulder] < 0) missing.push_back(name + "upper arm");
    if (body.arms[side][kElbow] < 0) missing.push_back(name + "elbow");
  }
  if (body.neck < 0 && body.head < 0) missing.emplace_back("neck or head");
  return missing;
}

int common_ancestor(const SkeletonView& skeleton, int a, int b) {
  const std::vector<int> path = skeleton.path_to_root(a);
  for (int j = b; j >= 0; j = skeleton.parents[static_cast<size_t>(j)]) {
    if (std::find(path.begin(), path.end(), j) != path.end()) return j;
  }
  return -1;
}

bool is_above(const SkeletonView& skeleton, int above, int joint) {
  for (int j = joint; j >= 0; j = skeleton.parents[static_cast<size_t>(j)]) {
    if (j == above) return true;
  }
  return false;
}

}  // namespace remomask::rig
