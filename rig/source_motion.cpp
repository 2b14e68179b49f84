#include "rig/source_motion.h"

namespace remomask::rig {

int SourceMotion::find_joint(std::string_view name) const {
  for (size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].name == name) return static_cast<int>(j);
  }
  return -1;
}

void place_joint(const SourceMotion& source, int frame, size_t joint, std::vector<Vec3>& positions,
                 std::vector<Quat>& rotations) {
  const SourceJoint& rest = source.joints[joint];
  Quat rotation = rest.rotation;
  Vec3 translation = rest.offset;
  if (frame >= 0) {
    const size_t at = static_cast<size_t>(frame) * source.joints.size() + joint;
    const float* q = source.rotations.data() + at * 4;
    const float* t = source.translations.data() + at * 3;
    rotation = Quat(q[3], q[0], q[1], q[2]);
    translation = Vec3(t[0], t[1], t[2]);
  }
  if (rest.parent < 0) {
    positions[joint] = translation;
    rotations[joint] = rotation;
  } else {
    const auto parent = static_cast<size_t>(rest.parent);
    positions[joint] = positions[parent] + rotations[parent] * translation;
    rotations[joint] = rotations[parent] * rotation;
  }
}

std::vector<Vec3> world_positions(const SourceMotion& source, int frame) {
  const size_t count = source.joints.size();
  std::vector<Vec3> positions(count);
  std::vector<Quat> rotations(count);
  for (size_t j = 0; j < count; ++j) place_joint(source, frame, j, positions, rotations);
  return positions;
}

}  // namespace remomask::rig
