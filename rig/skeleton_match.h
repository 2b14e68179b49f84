#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rig/humanoid.h"
#include "rig/skeleton_map.h"

namespace remomask::rig {

/// What the search for a human body in a skeleton came to.
struct SkeletonMatch {
  std::optional<SkeletonMap> map;    ///< named "rules"; empty if there is no human body
  bool by_names = true;              ///< false: found by shape, since the names say too little
  std::vector<std::string> missing;  ///< parts that neither names nor shape gave
  std::string objection;             ///< why what was found is not a human; empty if it is one
};

/// Recognises any human skeleton: by the names of its joints, whose double meanings the hierarchy
/// settles, and by shape where names say too little.
SkeletonMatch match_skeleton(const SkeletonView& skeleton);

}  // namespace remomask::rig
