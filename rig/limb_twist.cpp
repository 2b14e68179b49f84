#include "rig/limb_twist.h"

#include <algorithm>
#include <cmath>

#include "motion/rotation.h"

namespace remomask::rig {

namespace {

constexpr double kRestWeight = 0.05;  // against 1 for a hinge that shows
constexpr double kStiffness = 1;      // of the turn from frame to frame, at 20 fps
constexpr double kReferenceFps = 20;

/// Angle about `axis` (unit length) of a rotation that is about that axis only.
double angle_about(const Quat& rotation, const Vec3& axis) {
  return 2 * std::atan2(rotation.vec().dot(axis), rotation.w());
}

/// The angle that differs from `angle` by whole turns and is nearest to `near`.
double unwrap_angle(double angle, double near) {
  return near + std::remainder(angle - near, 2 * M_PI);
}

/// Angle about `axis` from `from` to `to`, both seen along the axis.
double angle_between(const Vec3& from, const Vec3& to, const Vec3& axis) {
  return std::atan2(axis.dot(from.cross(to)), from.dot(to) - axis.dot(from) * axis.dot(to));
}

/// Weighted wishes for the turn in each frame.
struct Wishes {
  std::vector<double> weight, angle;
};

/// Minimises sum weight (x - angle)^2 + stiffness (x_t - x_(t-1))^2.
std::vector<double> smooth_turns(const Wishes& wishes, double stiffness) {
  const size_t count = wishes.angle.size();
  std::vector<double> above(count, 0), result(count);
  for (size_t t = 0; t < count; ++t) {
    const double before = t > 0 ? stiffness : 0, after = t + 1 < count ? stiffness : 0;
    double diagonal = wishes.weight[t] + before + after + 1e-9;
    double right = wishes.weight[t] * wishes.angle[t];
    if (t > 0) {
      diagonal -= before * above[t - 1];
      right += before * result[t - 1];
    }
    above[t] = after / diagonal;
    result[t] = right / diagonal;
  }
  for (size_t t = count - 1; t-- > 0;) result[t] += above[t] * result[t + 1];
  return result;
}

}  // namespace

std::vector<Quat> limb_rotations(const std::vector<LimbFrame>& frames, const LimbRest& rest,
                                 double fps) {
  const Vec3 bone = rest.direction.normalized();
  const double stiffness = kStiffness * (fps / kReferenceFps) * (fps / kReferenceFps);
  // Rotations carried along from frame to frame without a turn about the bone. All turns are
  // measured from these, since the least turn from the rest pose spins where the bone points
  // opposite to it.
  std::vector<Quat> carried;
  Wishes wishes;
  Vec3 before = bone;
  Quat carry = Quat::Identity();
  double turn = 0;
  for (const LimbFrame& frame : frames) {
    const Vec3 direction = (frame.parent.conjugate() * frame.direction).normalized();
    carry = (motion::shortest_arc(before, direction) * carry).normalized();
    before = direction;
    carried.push_back(carry);
    const Quat least = motion::shortest_arc(bone, direction);
    const double rest_turn = unwrap_angle(angle_about(carry.conjugate() * least, bone), turn);
    const double opposite = 0.5 * (1 + bone.dot(direction));
    const double rest_weight = kRestWeight * std::min(1.0, 4 * opposite);
    const Vec3 hinge = frame.parent.conjugate() * frame.hinge;
    const double hinge_turn =
        unwrap_angle(angle_between(carry * rest.hinge, hinge, direction), turn);
    const double weight = rest_weight + frame.certainty;
    const double angle =
        (rest_weight * rest_turn + frame.certainty * hinge_turn) / std::max(weight, 1e-12);
    wishes.weight.push_back(weight);
    wishes.angle.push_back(angle);
    turn = carried.size() == 1 ? angle : turn + weight / (weight + stiffness) * (angle - turn);
  }
  const std::vector<double> turns = smooth_turns(wishes, stiffness);
  std::vector<Quat> result;
  for (size_t t = 0; t < frames.size(); ++t) {
    result.push_back(
        (frames[t].parent * carried[t] * Quat(Eigen::AngleAxisd(turns[t], bone))).normalized());
  }
  return result;
}

}  // namespace remomask::rig
