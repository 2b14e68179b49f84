#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "motion/vector.h"
#include "rig/source_motion.h"

namespace remomask::rig {

/// Where every joint is, and how it is turned, in the world.
struct SkeletonPose {
  std::vector<Vec3> positions;
  std::vector<Quat> rotations;
};

/// What the search for our joints needs to know about a skeleton, whatever file it came from.
struct SkeletonView {
  std::vector<std::string> names;
  std::vector<int> parents;                    ///< -1 for a root; parents come first
  std::vector<std::optional<Vec3>> end_sites;  ///< tip of the bone, in the joint's axes
  SkeletonPose rest;
  SkeletonPose first;  ///< the first frame, since rest poses need not stand; the rest pose if none

  size_t size() const { return names.size(); }
  int find_joint(std::string_view name) const;  ///< -1 if absent
  /// Joint and all above it, from itself to the root.
  std::vector<int> path_to_root(int joint) const;
};

SkeletonView view_of(const SourceMotion& source);

}  // namespace remomask::rig
