#pragma once

#include <map>
#include <string>
#include <vector>

#include "rig/source_motion.h"

namespace remomask::testing_support {

/// The names of a program's skeleton. "{a|b}" in the name of a limb's joint is a on the left and b
/// on the right; an empty name: there is no such joint.
struct RigNames {
  std::string program;
  std::vector<std::string> roots;  ///< above the pelvis
  std::string pelvis;
  std::vector<std::string> spine, necks;
  std::string head;
  std::vector<std::string> collars;  ///< from the spine outwards; the last one counts
  std::string shoulder, elbow, wrist;
  std::string hip, knee, ankle, toe;
  /// Others: "name<parent", with "{a|b}" on both sides.
  std::vector<std::string> others;
};

/// What a RigNames becomes: a person of 1.7 m in a T-pose who looks along +Z, centimetres.
struct BuiltRig {
  rig::SourceMotion motion;  ///< one frame, which is the T-pose
  /// Where our joints that are one of the rig's lie: "left_knee", ...
  std::map<std::string, Vec3> truth;
};

struct RigOptions {
  bool scrambled_rest = false;  ///< a rest pose in which no bone points where it should
  bool zero_offsets = false;    ///< bone lengths in the translations of the frame alone
  bool reversed = false;        ///< children in reverse order: right before left, spine before legs
};

BuiltRig build_rig(const RigNames& names, const RigOptions& options = {});

/// "{a|b}" on the left (0) or right (1).
std::string sided(const std::string& pattern, int side);

}  // namespace remomask::testing_support
