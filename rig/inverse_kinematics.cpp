#include "rig/inverse_kinematics.h"

#include <algorithm>
#include <cmath>

#include "motion/rotation.h"
#include "rig/limb_twist.h"

namespace remomask::rig {

namespace {

/// The joints of an arm or a leg, from the joint that carries it to its end.
struct Limb {
  size_t carrier, upper, hinge, end;
  size_t foot;  ///< a leg's toe joint; 0 for an arm
  /// Axis about which the hinge bends in the T-pose, so that a positive angle bends it.
  Vec3 axis;
};

const std::array<Limb, 4>& limbs() {
  static const std::array<Limb, 4> all = {{{0, 1, 4, 7, 10, Vec3::UnitX()},
                                           {0, 2, 5, 8, 11, Vec3::UnitX()},
                                           {13, 16, 18, 20, 0, -Vec3::UnitY()},
                                           {14, 17, 19, 21, 0, Vec3::UnitY()}}};
  return all;
}

double smooth_step(double low, double high, double value) {
  const double u = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

/// What a pose shows of a limb: the bend of its hinge, and for a leg also where the foot points.
LimbFrame limb_frame(const Limb& limb, const Pose& pose, const Quat& carrier) {
  const Vec3 upper = (pose[limb.hinge] - pose[limb.upper]).normalized();
  const Vec3 lower = (pose[limb.end] - pose[limb.hinge]).normalized();
  LimbFrame frame{carrier, upper, upper.cross(lower), 0};
  const double bend = frame.hinge.norm();
  // Sines of 5 and 25 degrees: below, the plane of the bend is noise.
  const double bent = smooth_step(0.09, 0.42, bend);
  frame.certainty = bent;
  if (bend > 1e-9) frame.hinge *= bent / bend;
  if (limb.foot == 0) return frame;
  const Vec3 foot = (pose[limb.foot] - pose[limb.end]).normalized();
  const Vec3 across = foot.cross(lower);
  const double shown = smooth_step(0.2, 0.7, across.norm());
  // Knees that bend backwards, as in motions that are no capture, must not turn the foot over.
  if (shown > 0 && frame.hinge.dot(across) < 0) frame.hinge = -frame.hinge;
  if (shown > 0) frame.hinge += (1 - bent) * shown * across.normalized();
  frame.certainty = std::max(bent, 0.5 * shown);
  return frame;
}

class PoseSolver {
 public:
  PoseSolver(const std::vector<Pose>& poses, const RestSkeleton& rest)
      : poses_(poses), rest_(rest), world_(poses.size()) {}

  WorldRotations solve(double fps) {
    for (size_t t = 0; t < poses_.size(); ++t) solve_trunk(t);
    for (const Limb& limb : limbs()) solve_limb(limb, fps);
    for (size_t t = 0; t < poses_.size(); ++t) {
      for (const size_t toe : {10, 11}) bend_toe(t, toe);
    }
    return std::move(world_);
  }

 private:
  /// Rotation of the joint that `carrier` carries, pointing its bone to `child` the shortest way.
  Quat aim(size_t t, const Quat& carrier, size_t joint, size_t child) const {
    const Vec3 bone = poses_[t][child] - poses_[t][joint];
    return (motion::shortest_arc(carrier * rest_.offsets[child], bone) * carrier).normalized();
  }

  Quat triangle(size_t t, size_t joint, size_t left, size_t right, size_t top) const {
    const Pose& pose = poses_[t];
    return rotation_of_triangle(rest_.offsets[left], rest_.offsets[right], rest_.offsets[top],
                                pose[left] - pose[joint], pose[right] - pose[joint],
                                pose[top] - pose[joint]);
  }

  void solve_trunk(size_t t) {
    auto& world = world_[t];
    world[0] = triangle(t, 0, 1, 2, 3);
    world[9] = triangle(t, 9, 13, 14, 12);
    // Between pelvis and chest the spine turns by thirds, before its bones take their directions.
    world[3] = aim(t, world[0].slerp(1 / 3.0, world[9]), 3, 6);
    world[6] = aim(t, world[0].slerp(2 / 3.0, world[9]), 6, 9);
    world[12] = aim(t, world[9], 12, 15);
    world[15] = world[12];
    world[13] = aim(t, world[9], 13, 16);
    world[14] = aim(t, world[9], 14, 17);
  }

  void solve_limb(const Limb& limb, double fps) {
    std::vector<LimbFrame> frames;
    for (size_t t = 0; t < poses_.size(); ++t) {
      frames.push_back(limb_frame(limb, poses_[t], world_[t][limb.carrier]));
    }
    const Vec3& upper = rest_.offsets[limb.hinge];
    const std::vector<Quat> turned = limb_rotations(frames, {upper, limb.axis}, fps);
    for (size_t t = 0; t < poses_.size(); ++t) {
      auto& world = world_[t];
      // The smoothed rotation aims only up to rounding; the arc makes it exact.
      world[limb.upper] = aim(t, turned[t], limb.upper, limb.hinge);
      world[limb.hinge] = aim(t, world[limb.upper], limb.hinge, limb.end);
      world[limb.end] = world[limb.hinge];
      if (limb.foot == 0) continue;
      world[limb.end] = aim(t, world[limb.hinge], limb.end, limb.foot);
      world[limb.foot] = world[limb.end];
    }
  }

  /// Turns the toes up about the foot's own left, so far that their tip stays above the floor or
  /// at the height of the joint below it.
  void bend_toe(size_t t, size_t toe) {
    Quat& rotation = world_[t][toe];
    const Vec3 tip = rotation * rest_.tips[toe];
    const double lowest = std::min(0.0, -poses_[t][toe].y());
    if (tip.y() >= lowest) return;
    const Vec3 left = rotation * Vec3::UnitX();
    const Vec3 up = tip.cross(left);  // where a turn about `left` against its sense moves the tip
    const double reach = std::hypot(tip.y(), up.y());
    if (reach <= std::abs(lowest)) return;
    // tip cos a + up sin a, its height set to `lowest`.
    const double phase = std::atan2(up.y(), tip.y());
    const double wanted = std::acos(std::clamp(lowest / reach, -1.0, 1.0));
    constexpr double kMaxBend = 1.3;
    const double angle = std::min(std::remainder(phase - wanted, 2 * M_PI), kMaxBend);
    if (angle <= 0) return;
    rotation = (Quat(Eigen::AngleAxisd(-angle, left)) * rotation).normalized();
  }

  const std::vector<Pose>& poses_;
  const RestSkeleton& rest_;
  WorldRotations world_;
};

}  // namespace

WorldRotations solve_world_rotations(const std::vector<Pose>& poses, const RestSkeleton& rest,
                                     double fps) {
  return PoseSolver(poses, rest).solve(fps);
}

}  // namespace remomask::rig
