#include "formats/smpl_rest.h"

#include "remomask/skeleton.h"

namespace remomask::formats {

namespace {

/// Directions of the bones that end in the joints of the middle and of the left side; the right
/// side is their mirror image. Hips, collars and feet slant, which T-pose diagrams leave out.
Vec3 rest_direction_of(const std::string& joint) {
  const std::string part = joint.substr(joint.find('_') + 1);
  if (part == "hip") return {0.60, -0.80, -0.02};
  if (part == "knee") return {0.10, -0.99, -0.01};
  if (part == "ankle") return {-0.03, -0.99, -0.09};
  if (part == "foot") return {0.25, -0.40, 0.88};
  if (part == "spine1") return {0, 0.97, -0.25};
  if (part == "spine2" || part == "spine3") return {0, 1, 0.04};
  if (part == "neck") return {0, 0.98, -0.18};
  if (part == "head") return {0, 0.87, 0.50};
  if (part == "collar") return {0.58, 0.80, -0.16};
  if (part == "shoulder") return {0.93, 0.35, -0.10};
  if (part == "elbow") return {0.99, -0.05, -0.10};
  if (part == "wrist") return {1, 0.03, -0.02};
  return Vec3::Zero();  // the pelvis
}

std::array<Vec3, 22> make_smpl_rest() {
  const Skeleton& skeleton = humanml_skeleton();
  std::array<Vec3, 22> offsets;
  for (size_t j = 0; j < offsets.size(); ++j) {
    const auto other = static_cast<size_t>(skeleton.mirror[j]);
    const double length = (skeleton.bone_lengths[j] + skeleton.bone_lengths[other]) / 2;
    Vec3 direction = rest_direction_of(skeleton.joint_names[j]);
    if (j != 0) direction.normalize();
    if (skeleton.joint_names[j].starts_with("right_")) direction.x() = -direction.x();
    offsets[j] = length * direction;
  }
  return offsets;
}

}  // namespace

const std::array<Vec3, 22>& smpl_rest_offsets() {
  static const std::array<Vec3, 22> offsets = make_smpl_rest();
  return offsets;
}

}  // namespace remomask::formats
