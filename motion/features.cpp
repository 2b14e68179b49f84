#include "motion/features.h"
#include "motion/vector.h"

#include <fmt/format.h>

#include <cmath>

#include "motion/feature_layout.h"
#include "motion/heading.h"
#include "motion/rest_pose.h"
#include "motion/rotation.h"
#include "remomask/error.h"

namespace remomask::motion {

namespace {

void require_usable(const Motion& motion, const Skeleton& skeleton) {
  if (motion.joints != skeleton.joints()) {
    throw Error(fmt::format("the motion has {} joints, the skeleton \"{}\" has {}", motion.joints,
                            skeleton.name, skeleton.joints()));
  }
  if (motion.frames < 2) {
    throw Error(fmt::format("features need at least 2 frames, the motion has {}", motion.frames));
  }
  for (size_t i = 0; i < motion.positions.size(); ++i) {
    if (!std::isfinite(motion.positions[i])) {
      throw Error(
          fmt::format("frame {}: a joint position is not a finite number", i / 3 / motion.joints));
    }
  }
}

/// HumanML3D's swing rotations: from world rest direction to world bone direction, each relative to
/// the previous one in its chain. Every chain, including those of the arms, starts from the facing
/// rotation.
void write_official_rotations(const Motion& motion, int frame, const Quat& facing,
                              const Skeleton& skeleton, float* out) {
  for (const std::vector<int>& chain : skeleton.chains) {
    Quat before = facing;
    for (size_t i = 1; i < chain.size(); ++i) {
      const Vec3 bone =
          joint_position(motion, frame, chain[i]) - joint_position(motion, frame, chain[i - 1]);
      const Quat world = shortest_arc(rest_direction(skeleton, chain[i]), bone);
      write_6d(before.conjugate() * world, out + (chain[i] - 1) * 6);
      before = world;
    }
  }
}

/// Swing rotations free of the heading: in the facing frame, each from the T-pose direction as
/// carried by its parent's rotation.
void write_fixed_rotations(const Motion& motion, int frame, const Quat& facing,
                           const Skeleton& skeleton, float* out) {
  const std::vector<Vec3>& rest = t_pose_directions(skeleton);
  std::vector<Quat> carried(skeleton.joints(), Quat::Identity());
  for (int j = 1; j < skeleton.joints(); ++j) {
    const int parent = skeleton.parents[j];
    const Vec3 bone =
        facing * (joint_position(motion, frame, j) - joint_position(motion, frame, parent));
    const Quat local = shortest_arc(rest[j], carried[parent].conjugate() * bone);
    write_6d(local, out + (j - 1) * 6);
    carried[j] = carried[parent] * local;
  }
}

/// Root position and facing rotation (world to facing frame) of every row.
struct RootPath {
  std::vector<Vec3> positions;
  std::vector<Quat> facing;
};

RootPath recover_root(const Features& features) {
  RootPath path;
  double half_angle = 0;
  Vec3 position = Vec3::Zero();
  for (int t = 0; t < features.frames; ++t) {
    const float* row = features.row(t);
    if (t > 0) half_angle += features.row(t - 1)[0];
    const Quat facing = yaw_rotation(2 * half_angle);
    if (t > 0) {
      const float* before = features.row(t - 1);
      position += facing.conjugate() * Vec3(before[1], 0, before[2]);
    }
    path.positions.emplace_back(position.x(), row[3], position.z());
    path.facing.push_back(facing);
  }
  return path;
}

void require_dimension(const Features& features, const Skeleton& skeleton) {
  if (features.dim != skeleton.feature_dim()) {
    throw Error(fmt::format("features of {} columns do not fit the skeleton \"{}\", which has {}",
                            features.dim, skeleton.name, skeleton.feature_dim()));
  }
}

}  // namespace

FeatureMode parse_feature_mode(const std::string& name) {
  if (name == "official") return FeatureMode::official;
  if (name == "fixed") return FeatureMode::fixed;
  throw Error("unknown feature mode \"" + name + "\"; use \"official\" or \"fixed\"");
}

const char* feature_mode_name(FeatureMode mode) {
  return mode == FeatureMode::official ? "official" : "fixed";
}

Features extract_features(const Motion& canonical, const Skeleton& skeleton, FeatureMode mode) {
  require_usable(canonical, skeleton);
  const Headings headings = find_headings(canonical, skeleton, mode);
  const int joints = skeleton.joints();
  const FeatureLayout layout(skeleton);
  Features features(canonical.frames - 1, skeleton.feature_dim());
  const auto facing_at = [&](int t) {
    return yaw_rotation(-(headings.angles[t] + headings.initial));
  };
  for (int t = 0; t < features.frames; ++t) {
    float* row = features.row(t);
    const Quat facing = facing_at(t), next_facing = facing_at(t + 1);
    const double half_turn = (headings.angles[t] - headings.angles[t + 1]) / 2;
    row[0] = static_cast<float>(mode == FeatureMode::official ? std::asin(std::sin(half_turn))
                                                              : half_turn);
    const Vec3 root = joint_position(canonical, t, 0);
    const Vec3 root_step = next_facing * (joint_position(canonical, t + 1, 0) - root);
    row[1] = static_cast<float>(root_step.x());
    row[2] = static_cast<float>(root_step.z());
    row[3] = static_cast<float>(root.y());
    const Eigen::Matrix3d to_facing = facing.toRotationMatrix();
    for (int j = 0; j < joints; ++j) {
      const Vec3 position = joint_position(canonical, t, j);
      const Vec3 step = to_facing * (joint_position(canonical, t + 1, j) - position);
      const Vec3 local = to_facing * (position - Vec3(root.x(), 0, root.z()));
      for (int axis = 0; axis < 3; ++axis) {
        row[layout.velocities + j * 3 + axis] = static_cast<float>(step[axis]);
        if (j > 0) row[layout.positions + (j - 1) * 3 + axis] = static_cast<float>(local[axis]);
      }
    }
    if (mode == FeatureMode::official) {
      write_official_rotations(canonical, t, facing, skeleton, row + layout.rotations);
    } else {
      write_fixed_rotations(canonical, t, facing, skeleton, row + layout.rotations);
    }
    float* contact = row + layout.contacts;
    for (const std::vector<int>* feet : {&skeleton.left_feet, &skeleton.right_feet}) {
      for (int joint : *feet) {
        const double moved =
            (joint_position(canonical, t + 1, joint) - joint_position(canonical, t, joint))
                .squaredNorm();
        *contact++ = moved < skeleton.contact_threshold ? 1.f : 0.f;
      }
    }
  }
  return features;
}

Features extract_features_all_frames(const Motion& canonical, const Skeleton& skeleton,
                                     FeatureMode mode) {
  if (canonical.frames < 1) throw Error("the motion has no frames");
  Motion longer(canonical.frames + 1, canonical.joints);
  std::copy(canonical.positions.begin(), canonical.positions.end(), longer.positions.begin());
  const float* last = canonical.at(canonical.frames - 1, 0);
  const float* before = canonical.at(std::max(0, canonical.frames - 2), 0);
  float* next = longer.at(canonical.frames, 0);
  for (int i = 0; i < canonical.joints * 3; ++i) next[i] = 2 * last[i] - before[i];
  return extract_features(longer, skeleton, mode);
}

Motion recover_motion(const Features& features, const Skeleton& skeleton) {
  require_dimension(features, skeleton);
  const FeatureLayout layout(skeleton);
  const RootPath path = recover_root(features);
  Motion motion(features.frames, skeleton.joints());
  motion.fps = skeleton.fps;
  motion.skeleton = skeleton.name;
  for (int t = 0; t < features.frames; ++t) {
    const Vec3& root = path.positions[t];
    const Quat to_world = path.facing[t].conjugate();
    set_joint_position(motion, t, 0, root);
    for (int j = 1; j < skeleton.joints(); ++j) {
      const float* local = features.row(t) + layout.positions + (j - 1) * 3;
      set_joint_position(
          motion, t, j,
          to_world * Vec3(local[0], local[1], local[2]) + Vec3(root.x(), 0, root.z()));
    }
  }
  return motion;
}

Motion recover_motion_with_next_frame(const Features& features, const Skeleton& skeleton) {
  const Motion motion = recover_motion(features, skeleton);
  if (features.frames == 0) return motion;
  const int last = features.frames - 1;
  const Quat to_world = recover_root(features).facing[last].conjugate();
  const float* velocity = features.row(last) + FeatureLayout(skeleton).velocities;
  Motion longer(features.frames + 1, skeleton.joints());
  std::copy(motion.positions.begin(), motion.positions.end(), longer.positions.begin());
  for (int j = 0; j < skeleton.joints(); ++j) {
    const Vec3 step(velocity[j * 3], velocity[j * 3 + 1], velocity[j * 3 + 2]);
    set_joint_position(longer, last + 1, j, joint_position(motion, last, j) + to_world * step);
  }
  return longer;
}

}  // namespace remomask::motion
