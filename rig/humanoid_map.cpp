#include "rig/humanoid_map.h"

#include <algorithm>
#include <cmath>

#include "rig/humanoid_shape.h"

namespace remomask::rig {

namespace {

// How far up from the hips to the neck the pelvis and the three joints of the SMPL spine lie.
constexpr std::array<double, 4> kTrunkFractions = {0.13, 0.33, 0.53, 0.66};
// A joint this near to where ours should be is taken as it is, since a body bends at its joints.
constexpr double kSnap = 0.05;

/// Writes the points of a body.
class MapWriter {
 public:
  MapWriter(const SkeletonView& skeleton, const Humanoid& body)
      : skeleton_(skeleton), body_(body), rest_(skeleton.rest.positions) {}

  SkeletonMap write() {
    map_.name = "rules";
    const double leg = limb_length(body_.legs[0]);
    write_trunk();
    for (int side = 0; side < 2; ++side) {
      const LimbJoints& leg_joints = body_.legs[at(side)];
      const LimbJoints& arm = body_.arms[at(side)];
      point(1 + side) = joint(leg_joints[kHip]);
      point(4 + side) = joint(leg_joints[kKnee]);
      point(7 + side) = joint(leg_joints[kAnkle]);
      point(10 + side) = toe(leg_joints, leg);
      point(13 + side) = collar(arm);
      point(16 + side) = joint(arm[kShoulder]);
      point(18 + side) = joint(arm[kElbow]);
      point(20 + side) = wrist(arm);
    }
    return map_;
  }

 private:
  MappedPoint& point(int ours) { return map_.points[at(ours)]; }
  const std::string& name(int joint) const { return skeleton_.names[at(joint)]; }
  const std::optional<Vec3>& end_site(int joint) const { return skeleton_.end_sites[at(joint)]; }
  double distance(int a, int b) const { return (rest_[at(a)] - rest_[at(b)]).norm(); }
  double limb_length(const LimbJoints& leg) const {
    return distance(leg[kHip], leg[kKnee]) + distance(leg[kKnee], leg[kAnkle]);
  }

  MappedPoint joint(int of) const { return {name(of), "", false, std::nullopt, 0}; }
  MappedPoint blend(int from, int to, double weight) const {
    weight = std::round(weight * 1e4) / 1e4;
    if (from == to || weight <= 0) return joint(from);
    if (weight >= 1) return joint(to);
    return {name(from), name(to), false, std::nullopt, weight};
  }
  MappedPoint end_of(int of, double weight = 1) const {
    return {name(of), "", true, std::nullopt, weight};
  }
  /// A point fixed to a joint that is at `world` in the pose.
  MappedPoint fixed(int of, const SkeletonPose& pose, const Vec3& world) const {
    const Vec3 offset = pose.rotations[at(of)].conjugate() * (world - pose.positions[at(of)]);
    return {name(of), "", false, offset, 1};
  }

  void write_trunk() {
    const int top = trunk_top(body_);
    std::vector<int> line = {body_.pelvis};
    line.insert(line.end(), body_.spine.begin(), body_.spine.end());
    line.push_back(top);
    // Heights along the line, from the hips: the pelvis joint may be above or below them.
    std::vector<double> height(line.size());
    const Vec3 hips = hip_centre(skeleton_.rest, body_);
    const Vec3 above = rest_[at(line[0])] - hips;
    const Vec3 upward = rest_[at(line[1])] - hips;
    height[0] = above.dot(upward) >= 0 ? above.norm() : -above.norm();
    for (size_t i = 1; i < line.size(); ++i) {
      height[i] = height[i - 1] + distance(line[i - 1], line[i]);
    }
    double neck_height = height.back();
    if (body_.neck < 0) neck_height -= 0.14 * height.back();  // the line ends in the head
    constexpr std::array<int, 4> kOurs = {0, 3, 6, 9};
    for (size_t i = 0; i < kOurs.size(); ++i) {
      point(kOurs[i]) = point_at(line, height, kTrunkFractions[i] * neck_height,
                                 i == 0 ? 0.04 * neck_height : kSnap * neck_height);
    }
    write_neck(line, height, neck_height);
  }

  /// The point of a line of joints at a height, or a joint at most `snap` away.
  MappedPoint point_at(const std::vector<int>& line, const std::vector<double>& height,
                       double wanted, double snap) const {
    size_t nearest = 0;
    for (size_t i = 1; i < line.size(); ++i) {
      if (std::abs(height[i] - wanted) < std::abs(height[nearest] - wanted)) nearest = i;
    }
    if (std::abs(height[nearest] - wanted) <= snap) return joint(line[nearest]);
    for (size_t i = 1; i < line.size(); ++i) {
      if (wanted > height[i] || height[i] <= height[i - 1]) continue;
      return blend(line[i - 1], line[i], (wanted - height[i - 1]) / (height[i] - height[i - 1]));
    }
    return joint(line[nearest]);
  }

  void write_neck(const std::vector<int>& line, const std::vector<double>& height,
                  double neck_height) {
    if (body_.neck < 0) {
      point(12) = point_at(line, height, neck_height, 0.02 * neck_height);
      point(15) = joint(body_.head);
      return;
    }
    const double usual = 0.18 * neck_height;  // from our neck to our head
    if (body_.head >= 0) {
      // A neck that begins deep in the chest: ours is nearer to the head.
      const double length = distance(body_.neck, body_.head);
      point(12) = length > 1.5 * usual
                      ? blend(body_.neck, body_.head, std::min(0.5, 1 - 1.25 * usual / length))
                      : joint(body_.neck);
      point(15) = joint(body_.head);
    } else if (end_site(body_.neck) && end_site(body_.neck)->norm() > 1e-9) {
      point(12) = joint(body_.neck);
      point(15) = end_of(body_.neck, std::min(1., usual / end_site(body_.neck)->norm()));
    } else {
      point(12) = joint(body_.neck);
      const SkeletonPose& pose = pose_of_body();
      const Vec3& neck = pose.positions[at(body_.neck)];
      const Vec3 up = (neck - pose.positions[at(line[line.size() - 2])]).normalized();
      point(15) = fixed(body_.neck, pose, neck + usual * up);
    }
  }

  const SkeletonPose& pose_of_body() const {
    const SkeletonPose* standing = standing_pose(skeleton_, body_);
    return standing ? *standing : skeleton_.first;
  }

  /// Without a toe joint: the End Site of the foot, else a point before the foot.
  MappedPoint toe(const LimbJoints& leg, double leg_length) const {
    if (leg[kToe] >= 0) return joint(leg[kToe]);
    const int ankle = leg[kAnkle];
    if (end_site(ankle) && end_site(ankle)->norm() > 0.06 * leg_length) return end_of(ankle);
    for (size_t j = 0; j < skeleton_.size(); ++j) {
      if (skeleton_.parents[j] != ankle) continue;
      if (distance(ankle, static_cast<int>(j)) > 0.06 * leg_length) {
        return joint(static_cast<int>(j));
      }
    }
    const SkeletonPose& pose = pose_of_body();
    const Vec3 up = (pose.positions[at(trunk_top(body_))] - hip_centre(pose, body_)).normalized();
    const Vec3 left =
        (pose.positions[at(body_.legs[0][kHip])] - pose.positions[at(body_.legs[1][kHip])])
            .normalized();
    const Vec3 forward = left.cross(up).normalized();
    return fixed(ankle, pose,
                 pose.positions[at(ankle)] + leg_length * (0.16 * forward - 0.07 * up));
  }

  /// A collar bone that begins in the middle of the body is ours from a third on.
  MappedPoint collar(const LimbJoints& arm) const {
    const int shoulder = arm[kShoulder];
    const std::vector<Vec3>& pose = pose_of_body().positions;
    const Vec3 left = pose[at(body_.arms[0][kShoulder])],
               right = pose[at(body_.arms[1][kShoulder])];
    const Vec3 across = left - right;
    const auto lateral = [&](int joint) {
      return std::abs((pose[at(joint)] - (left + right) / 2).dot(across.normalized())) /
             std::max(1e-9, across.norm() / 2);
    };
    if (arm[kCollar] >= 0) {
      const double begin = lateral(arm[kCollar]);
      return begin < 0.25 ? blend(arm[kCollar], shoulder, (0.35 - begin) / (1 - begin))
                          : joint(arm[kCollar]);
    }
    const int top = body_.neck >= 0       ? body_.neck
                    : body_.spine.empty() ? body_.head
                                          : body_.spine.back();
    return blend(top, shoulder, 0.4);
  }

  /// Without a hand: the End Site of the forearm, else a point as far on as the upper arm is long.
  MappedPoint wrist(const LimbJoints& arm) const {
    if (arm[kWrist] >= 0) return joint(arm[kWrist]);
    const int elbow = arm[kElbow];
    const double upper = distance(arm[kShoulder], elbow);
    if (end_site(elbow) && end_site(elbow)->norm() > 0.4 * upper) return end_of(elbow);
    for (size_t j = 0; j < skeleton_.size(); ++j) {
      const int child = static_cast<int>(j);
      if (skeleton_.parents[j] == elbow && distance(elbow, child) > 0.5 * upper) {
        return joint(child);
      }
    }
    const SkeletonPose& pose = skeleton_.rest;
    const Vec3& from = pose.positions[at(elbow)];
    const Vec3 onward = (from - pose.positions[at(arm[kShoulder])]).normalized();
    return fixed(elbow, pose, from + 0.95 * upper * onward);
  }

  const SkeletonView& skeleton_;
  const Humanoid& body_;
  const std::vector<Vec3>& rest_;
  SkeletonMap map_;
};

}  // namespace

SkeletonMap map_of_body(const SkeletonView& skeleton, const Humanoid& body) {
  return MapWriter(skeleton, body).write();
}

}  // namespace remomask::rig
