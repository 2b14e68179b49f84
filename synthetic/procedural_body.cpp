#include "synthetic/procedural_body.h"
#include "motion/body_joints.h"
#include "motion/vector.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace remomask::synthetic {

namespace {

using enum motion::BodyJoint;

constexpr double kLegReach = 0.993;   // of the leg's length: a knee is never locked
constexpr double kSteepestFoot = 62;  // degrees of heel lift on the floor
constexpr int kSinkWindow = 2;        // frames over which the sinking of the pelvis is spread

Quat turn_about(const Vec3& axis, double degrees) {
  return Quat(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis));
}
Quat turn_x(double degrees) { return turn_about(Vec3::UnitX(), degrees); }
Quat turn_y(double degrees) { return turn_about(Vec3::UnitY(), degrees); }
Quat turn_z(double degrees) { return turn_about(Vec3::UnitZ(), degrees); }

double bone_length(int joint) { return humanml_skeleton().bone_lengths[joint]; }

/// Bone that ends in `joint`, of a relaxed body: hips lie below the pelvis,
/// shoulders out and a little back. Rounded by eye.
Vec3 natural_bone(int joint) {
  Vec3 direction;
  switch (joint) {
    case kBodyLeftHip:
      direction = {0.60, -0.79, -0.10};
      break;
    case kBodyRightHip:
      direction = {-0.60, -0.79, -0.10};
      break;
    case kBodySpine1:
      direction = {0, 0.96, -0.25};
      break;
    case kBodySpine2:
      direction = {0, 0.98, 0.15};
      break;
    case kBodySpine3:
      direction = {0, 1, 0.05};
      break;
    case kBodyNeck:
      direction = {0, 0.99, -0.14};
      break;
    case kBodyLeftCollar:
      direction = {0.54, 0.83, -0.10};
      break;
    case kBodyRightCollar:
      direction = {-0.54, 0.83, -0.10};
      break;
    case kBodyHead:
      direction = {0, 0.88, 0.47};
      break;
    case kBodyLeftShoulder:
      direction = {0.94, 0.30, -0.15};
      break;
    case kBodyRightShoulder:
      direction = {-0.94, 0.30, -0.15};
      break;
    case kBodyLeftToe:
      direction = {0.12, -0.42, 0.90};
      break;
    case kBodyRightToe:
      direction = {-0.12, -0.42, 0.90};
      break;
    default:
      direction = {0, -1, 0};
      break;
  }
  return direction.normalized() * bone_length(joint);
}

Quat pelvis_rotation(const BodyPose& pose) {
  return turn_y(pose.yaw) * turn_x(pose.pitch) * turn_z(-pose.roll);
}

Vec3 ankle_target(const FootPose& foot, int side) {
  // A lifted toe turns around the ankle, which stays where the flat foot has it.
  return foot.ball + toe_to_ankle(side, foot.yaw, std::max(foot.pitch, 0.0));
}

double leg_reach(int side) {
  return kLegReach * (bone_length(kBodyLeftKnee + side) + bone_length(kBodyLeftAnkle + side));
}

Vec3 hip_position(const BodyPose& pose, int side) {
  return pose.pelvis + pelvis_rotation(pose) * natural_bone(kBodyLeftHip + side);
}

/// Lifts the heel of a flat standing foot that the leg is too short for, as a
/// walker's trailing foot does, as far as that brings the ankle nearer.
void lift_heel(BodyPose& pose, int side) {
  FootPose& foot = pose.feet[side];
  if (!foot.planted || foot.pitch < 0) return;
  const Vec3 hip = hip_position(pose, side);
  const auto distance = [&](double pitch) {
    return (foot.ball + toe_to_ankle(side, foot.yaw, pitch) - hip).norm();
  };
  const double reach = leg_reach(side);
  double low = foot.pitch, high = kSteepestFoot;
  if (low >= high || distance(low) <= reach || distance(high) >= distance(low)) return;
  for (int i = 0; i < 30; ++i) {
    const double middle = (low + high) / 2;
    (distance(middle) > reach ? low : high) = middle;
  }
  foot.pitch = high;
}

/// How far the pelvis must sink for its planted feet to be reached.
double needed_sink(const BodyPose& pose) {
  double sink = 0;
  for (int side = 0; side < 2; ++side) {
    if (!pose.feet[side].planted) continue;
    const Vec3 hip = hip_position(pose, side);
    const Vec3 ankle = ankle_target(pose.feet[side], side);
    const double across = std::hypot(hip.x() - ankle.x(), hip.z() - ankle.z());
    const double reach = leg_reach(side);
    const double height = std::sqrt(std::max(reach * reach - across * across, 0.01));
    sink = std::max(sink, hip.y() - ankle.y() - height);
  }
  return sink;
}

/// Lowers the pelvis where legs are too short. The largest need within a window
/// is averaged over the same window, so it is smooth and everywhere sufficient.
void sink_pelvis(std::vector<BodyPose>& poses) {
  const int frames = static_cast<int>(poses.size());
  std::vector<double> need(frames), widest(frames);
  for (int f = 0; f < frames; ++f) need[f] = needed_sink(poses[f]);
  const auto window = [&](int f, auto&& visit) {
    for (int i = -kSinkWindow; i <= kSinkWindow; ++i) visit(std::clamp(f + i, 0, frames - 1));
  };
  for (int f = 0; f < frames; ++f) {
    window(f, [&](int g) { widest[f] = std::max(widest[f], need[g]); });
  }
  for (int f = 0; f < frames; ++f) {
    double sum = 0;
    window(f, [&](int g) { sum += widest[g]; });
    poses[f].pelvis.y() -= sum / (2 * kSinkWindow + 1);
  }
}

void place_leg(const BodyPose& pose, int side, const Vec3& hip, Motion& motion, int frame) {
  const FootPose& foot = pose.feet[side];
  const double upper = bone_length(kBodyLeftKnee + side),
               lower = bone_length(kBodyLeftAnkle + side);
  const Vec3 target = ankle_target(foot, side);
  const Vec3 direction = (target - hip).normalized();
  const double distance = std::clamp((target - hip).norm(), 0.3, 0.9995 * (upper + lower));
  const Vec3 ankle = hip + direction * distance;
  // Knees bend to the front, half way between pelvis and foot, a little outward.
  const Quat facing = turn_y((pose.yaw + foot.yaw) / 2);
  const Vec3 pole = facing * Vec3(0.12 * side_sign(side), 0.5, 1);
  const Vec3 out = (pole - direction * pole.dot(direction)).normalized();
  const double along = (upper * upper - lower * lower + distance * distance) / (2 * distance);
  const double away = std::sqrt(std::max(upper * upper - along * along, 0.0));
  set_joint_position(motion, frame, kBodyLeftHip + side, hip);
  set_joint_position(motion, frame, kBodyLeftKnee + side, hip + direction * along + out * away);
  set_joint_position(motion, frame, kBodyLeftAnkle + side, ankle);
  set_joint_position(motion, frame, kBodyLeftToe + side,
                     ankle - toe_to_ankle(side, foot.yaw, foot.pitch));
}

void place_arm(const ArmPose& arm, int side, const Quat& chest, const Vec3& collar, Motion& motion,
               int frame) {
  const double s = side_sign(side);
  const Quat upper =
      turn_z(s * arm.abduct) * turn_y(-s * arm.across) * turn_x(-arm.flex) * turn_y(s * arm.twist);
  const Vec3 down(0, -1, 0);
  // The shoulder girdle takes part in raising: little at first, 30 degrees overhead.
  const double raised = std::acos(std::clamp((upper * down).dot(down), -1.0, 1.0));
  const double shrug = 30 * std::pow(raised / std::numbers::pi, 2);
  const Vec3 shoulder =
      collar + chest * (turn_z(s * shrug) * natural_bone(kBodyLeftShoulder + side));
  const Vec3 elbow = shoulder + chest * (upper * natural_bone(kBodyLeftElbow + side));
  const Vec3 wrist =
      elbow + chest * (upper * (turn_x(-arm.elbow) * natural_bone(kBodyLeftWrist + side)));
  set_joint_position(motion, frame, kBodyLeftShoulder + side, shoulder);
  set_joint_position(motion, frame, kBodyLeftElbow + side, elbow);
  set_joint_position(motion, frame, kBodyLeftWrist + side, wrist);
}

void place_body(const BodyPose& pose, Motion& motion, int frame) {
  Quat rotation = pelvis_rotation(pose);
  Vec3 at = pose.pelvis;
  set_joint_position(motion, frame, kBodyPelvis, at);
  for (int side = 0; side < 2; ++side) {
    place_leg(pose, side, hip_position(pose, side), motion, frame);
  }
  for (int joint : {kBodySpine1, kBodySpine2, kBodySpine3}) {
    at += rotation * natural_bone(joint);
    set_joint_position(motion, frame, joint, at);
    rotation = rotation * turn_y(pose.twist / 3) * turn_x(pose.bend / 3) * turn_z(-pose.lean / 3);
  }
  for (int side = 0; side < 2; ++side) {
    const Vec3 collar = at + rotation * natural_bone(kBodyLeftCollar + side);
    set_joint_position(motion, frame, kBodyLeftCollar + side, collar);
    place_arm(pose.arms[side], side, rotation, collar, motion, frame);
  }
  const Vec3 neck = at + rotation * natural_bone(kBodyNeck);
  set_joint_position(motion, frame, kBodyNeck, neck);
  const Quat head = rotation * turn_y(pose.look) * turn_x(pose.nod);
  set_joint_position(motion, frame, kBodyHead, neck + head * natural_bone(kBodyHead));
}

}  // namespace

double min_jerk(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10 + u * (6 * u - 15));
}

double ease(double time, double from, double to) {
  return to > from ? min_jerk((time - from) / (to - from)) : (time >= to ? 1.0 : 0.0);
}

double pulse(double time, double from, double to, double ramp) {
  return ease(time, from, from + ramp) - ease(time, to - ramp, to);
}

ArmPose mix(const ArmPose& a, const ArmPose& b, double weight) {
  const auto between = [&](double x, double y) { return x + (y - x) * weight; };
  return {between(a.flex, b.flex), between(a.abduct, b.abduct), between(a.across, b.across),
          between(a.twist, b.twist), between(a.elbow, b.elbow)};
}

double standing_height() {
  return leg_reach(1) - natural_bone(kBodyRightHip).y() - natural_bone(kBodyRightToe).y() - 0.008;
}

Vec3 toe_to_ankle(int side, double yaw, double pitch) {
  return -(turn_y(yaw) * (turn_x(pitch) * natural_bone(kBodyLeftToe + side)));
}

Motion solve_body(std::vector<BodyPose> poses) {
  for (BodyPose& pose : poses) {
    for (int side = 0; side < 2; ++side) lift_heel(pose, side);
  }
  sink_pelvis(poses);
  Motion motion(static_cast<int>(poses.size()), humanml_skeleton().joints());
  for (int f = 0; f < motion.frames; ++f) place_body(poses[f], motion, f);
  return motion;
}

}  // namespace remomask::synthetic
