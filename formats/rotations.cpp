#include "remomask/rotations.h"

#include <fmt/format.h>

#include "formats/inverse_kinematics.h"
#include "remomask/error.h"

namespace remomask {

namespace {

Vector3 to_vector3(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

Quaternion to_quaternion(const Quat& q) {
  return {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
          static_cast<float>(q.w())};
}

}  // namespace

JointRotations solve_rotations(const Motion& motion) {
  const Skeleton& skeleton = humanml_skeleton();
  if (motion.joints != skeleton.joints()) {
    throw Error(fmt::format("rotations are solved for {} joints, this motion has {}",
                            skeleton.joints(), motion.joints));
  }
  const formats::Pose22 pose = formats::solve_pose(motion);
  JointRotations result;
  result.frames = motion.frames;
  result.fps = motion.fps;
  result.joint_names = skeleton.joint_names;
  result.parents = skeleton.parents;
  result.rigid = pose.rigid;
  for (const Vec3& offset : pose.rest_offsets) result.rest_offsets.push_back(to_vector3(offset));
  for (const Vec3& root : pose.root) result.root.push_back(to_vector3(root));
  for (const Quat& rotation : pose.local) result.rotations.push_back(to_quaternion(rotation));
  for (const Vec3& translation : pose.translations) {
    result.translations.push_back(to_vector3(translation));
  }
  return result;
}

}  // namespace remomask
