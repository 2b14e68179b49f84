#include "rig/source_motion.h"

namespace remomask::rig {

int SourceMotion::find_joint(std::string_view name) const {
  for (size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].name == name) return static_cast<int>(j);
  }
  return -1;
}

std::vector<Vec3> world_positions(const SourceMotion& source, int frame) {
  const size_t count = source.joints.size();
  std::vector<Vec3> positions(count);
  std::vector<Quat> rotations(count);
  for (size_t j = 0; j < count; ++j) {
    const SourceJoint& joint = source.joints[j];
    Quat rotation = joint.rotation;
    Vec3 translation = joint.offset;
    if (frame >= 0) {
      const size_t at = static_cast<size_t>(frame) * count + j;
      const float* q = source.rotations.data() + at * 4;
      const float* t = source.translations.data() + at * 3;
      rotation = Quat(q[3], q[0], q[1], q[2]);
      translation = Vec3(t[0], t[1], t[2]);
    }
    if (joint.parent < 0) {
      positions[j] = translation;
      rotations[j] = rotation;
    } else {
      const auto parent = static_cast<size_t>(joint.parent);
      positions[j] = positions[parent] + rotations[parent] * translation;
      rotations[j] = rotations[parent] * rotation;
    }
  }
  return positions;
}

}  // namespace remomask::rig
