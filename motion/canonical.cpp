#include "motion/canonical.h"
#include "motion/vector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/heading.h"
#include "motion/rotation.h"
#include "remomask/error.h"

namespace remomask::motion {

namespace {

void require_finite(const Motion& motion, const Skeleton& skeleton) {
  if (motion.joints != skeleton.joints()) {
    throw Error(fmt::format("the motion has {} joints, the skeleton \"{}\" has {}", motion.joints,
                            skeleton.name, skeleton.joints()));
  }
  if (motion.frames < 1) throw Error("the motion has no frames");
  for (int t = 0; t < motion.frames; ++t) {
    for (int j = 0; j < motion.joints; ++j) {
      if (!joint_position(motion, t, j).allFinite()) {
        throw Error(fmt::format("frame {}, joint {}: the position is not a finite number", t,
                                skeleton.joint_names[j]));
      }
    }
  }
}

/// Closed form of HumanML3D's inverse and forward kinematics: all rotations cancel, so each bone
/// keeps its direction and takes the target length, and the root path is scaled by the leg length.
Motion with_uniform_bones(const Motion& raw, const Skeleton& skeleton) {
  const auto bone = [&](int joint) {
    return (joint_position(raw, 0, joint) - joint_position(raw, 0, skeleton.parents[joint])).norm();
  };
  const double source = bone(skeleton.leg_upper) + bone(skeleton.leg_lower);
  const double target =
      skeleton.bone_lengths[skeleton.leg_upper] + skeleton.bone_lengths[skeleton.leg_lower];
  if (!(source > 1e-9)) {
    throw Error("the " + skeleton.joint_names[skeleton.leg_upper] + " and " +
                skeleton.joint_names[skeleton.leg_lower] +
                " bones have no length in the first frame; check the skeleton map");
  }
  if (!(target > 0)) {
    throw Error("the skeleton \"" + skeleton.name +
                "\" has no uniform bone lengths; canonicalize without uniform_skeleton");
  }
  const double scale = target / source;
  Motion result(raw.frames, raw.joints);
  std::vector<Vec3> now(raw.joints);
  for (int t = 0; t < raw.frames; ++t) {
    now[0] = scale * joint_position(raw, t, 0);
    set_joint_position(result, t, 0, now[0]);
    for (int j = 1; j < raw.joints; ++j) {
      const int parent = skeleton.parents[j];
      Vec3 direction = joint_position(raw, t, j) - joint_position(raw, t, parent);
      const double length = direction.norm();
      direction = length > 1e-9 ? Vec3(direction / length) : rest_direction(skeleton, j);
      now[j] = now[parent] + skeleton.bone_lengths[j] * direction;
      set_joint_position(result, t, j, now[j]);
    }
  }
  return result;
}

}  // namespace

Motion canonicalize(const Motion& raw, const Skeleton& skeleton, const CanonicalOptions& options) {
  require_finite(raw, skeleton);
  Motion motion = options.uniform_skeleton ? with_uniform_bones(raw, skeleton) : raw;
  Vec3 shift = Vec3::Zero();
  if (options.floor) {
    double lowest = std::numeric_limits<double>::infinity();
    for (size_t i = 1; i < motion.positions.size(); i += 3) {
      lowest = std::min<double>(lowest, motion.positions[i]);
    }
    shift.y() = -lowest;
  }
  if (options.origin) {
    shift.x() = -joint_position(motion, 0, 0).x();
    shift.z() = -joint_position(motion, 0, 0).z();
  }
  Quat turn = Quat::Identity();
  if (options.facing) {
    const Vec3 forward = Vec3::UnitY().cross(across_body(motion, 0, skeleton));
    turn = yaw_rotation(-std::atan2(forward.x(), forward.z()));
  }
  const Eigen::Matrix3d matrix = turn.toRotationMatrix();
  for (int t = 0; t < motion.frames; ++t) {
    for (int j = 0; j < motion.joints; ++j) {
      set_joint_position(motion, t, j, matrix * (joint_position(motion, t, j) + shift));
    }
  }
  return motion;
}

Motion mirror_motion(const Motion& motion, const Skeleton& skeleton) {
  Motion result(motion.frames, motion.joints);
  for (int t = 0; t < motion.frames; ++t) {
    for (int j = 0; j < motion.joints; ++j) {
      const float* from = motion.at(t, skeleton.mirror[j]);
      float* to = result.at(t, j);
      to[0] = -from[0];
      to[1] = from[1];
      to[2] = from[2];
    }
  }
  return result;
}

Motion resample(const Motion& motion, double source_fps, double target_fps) {
  if (!(source_fps > 0) || !(target_fps > 0)) throw Error("a frame rate must be above zero");
  if (motion.frames < 2 || source_fps == target_fps) return motion;
  const double seconds = (motion.frames - 1) / source_fps;
  // The small addition keeps the last frame of clips whose length is a whole number of target
  // frames up to the rounding of the frame time.
  const int frames = static_cast<int>(seconds * target_fps + 1e-3) + 1;
  Motion result(frames, motion.joints);
  for (int t = 0; t < frames; ++t) {
    const double at = std::min(t / target_fps * source_fps, motion.frames - 1.0);
    const int before = std::min(static_cast<int>(at), motion.frames - 2);
    const double weight = at - before;
    const float* a = motion.at(before, 0);
    const float* b = motion.at(before + 1, 0);
    float* out = result.at(t, 0);
    for (int i = 0; i < motion.joints * 3; ++i) {
      out[i] = static_cast<float>((1 - weight) * a[i] + weight * b[i]);
    }
  }
  return result;
}

}  // namespace remomask::motion
