#include "rig/humanoid_shape.h"

#include <algorithm>
#include <cmath>

#include "rig/trunk_names.h"

namespace remomask::rig {

namespace {

/// Direction from the hips to the top of the trunk.
Vec3 trunk_direction(const SkeletonPose& pose, const Humanoid& body) {
  return pose.positions[at(trunk_top(body))] - hip_centre(pose, body);
}

Vec3 leg_direction(const SkeletonPose& pose, const Humanoid& body, size_t side) {
  return pose.positions[at(body.legs[side][kAnkle])] - pose.positions[at(body.legs[side][kHip])];
}

double cosine(const Vec3& a, const Vec3& b) {
  const double lengths = a.norm() * b.norm();
  return lengths > 1e-12 ? a.dot(b) / lengths : 0;
}

/// The longest way down from a joint.
struct Chain {
  std::vector<int> joints;
  std::vector<double> bones;  ///< that end in joints[1], joints[2], ...
  double length = 0;
};

/// Searches pairs of like chains in a skeleton's rest pose.
class ShapeFinder {
 public:
  ShapeFinder(const SkeletonView& skeleton, const std::vector<NameReading>& names)
      : skeleton_(skeleton), names_(names), children_(skeleton.size()), down_(skeleton.size()) {
    for (size_t j = skeleton.size(); j-- > 0;) {
      const int parent = skeleton.parents[j];
      if (parent >= 0) children_[at(parent)].insert(children_[at(parent)].begin(), j);
    }
    for (size_t j = skeleton.size(); j-- > 0;) {
      Chain& chain = down_[j];
      for (const size_t child : children_[j]) {
        const double bone = (skeleton.rest.positions[child] - skeleton.rest.positions[j]).norm();
        if (down_[child].length + bone < chain.length) continue;
        if (chain.length > 0 && down_[child].length + bone == chain.length) continue;
        chain.length = down_[child].length + bone;
        chain.joints = down_[child].joints;
        chain.bones = down_[child].bones;
        chain.bones.insert(chain.bones.begin(), bone);
      }
      chain.joints.insert(chain.joints.begin(), static_cast<int>(j));
    }
  }

  std::optional<Humanoid> find() const {
    const std::vector<Pair> pairs = like_pairs();
    for (const Pair& legs : pairs) {
      for (const Pair& arms : pairs) {
        if (&legs == &arms || legs.joint == arms.joint ||
            !is_above(skeleton_, legs.joint, arms.joint)) {
          continue;
        }
        if (std::optional<Humanoid> body = assemble(legs, arms)) return body;
      }
    }
    return std::nullopt;
  }

 private:
  struct Pair {
    int joint;
    std::array<int, 2> first;  ///< first joint of either chain
    double length;
  };

  bool alike(const Chain& a, const Chain& b) const {
    if (a.bones.size() != b.bones.size() || a.bones.size() < 2) return false;
    for (size_t i = 0; i < a.bones.size(); ++i) {
      if (std::abs(a.bones[i] - b.bones[i]) > 0.08 * std::max(a.length, b.length)) return false;
    }
    return true;
  }

  /// Pairs of like chains, the longest first.
  std::vector<Pair> like_pairs() const {
    std::vector<Pair> pairs;
    double longest = 0;
    for (size_t j = 0; j < skeleton_.size(); ++j) {
      for (size_t a = 0; a < children_[j].size(); ++a) {
        for (size_t b = a + 1; b < children_[j].size(); ++b) {
          const size_t first = children_[j][a], second = children_[j][b];
          if (!alike(down_[first], down_[second])) continue;
          pairs.push_back({static_cast<int>(j),
                           {static_cast<int>(first), static_cast<int>(second)},
                           down_[first].length});
          longest = std::max(longest, down_[first].length);
        }
      }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.length > b.length; });
    // Fingers, ears and the like are pairs, too, but short ones.
    while (!pairs.empty() && pairs.back().length < 0.35 * longest) pairs.pop_back();
    return pairs;
  }

  /// The joints at the ends of the two longest bones of a chain that follow each other.
  std::optional<std::array<size_t, 3>> long_bones(const Chain& chain) const {
    std::optional<std::array<size_t, 3>> best;
    double longest = 0;
    for (size_t i = 0; i + 2 < chain.joints.size(); ++i) {
      const double shorter = std::min(chain.bones[i], chain.bones[i + 1]);
      if (shorter <= longest * 1.0001) continue;
      longest = shorter;
      best = {i, i + 1, i + 2};
    }
    return best;
  }

  std::optional<Humanoid> assemble(const Pair& legs, const Pair& arms) const {
    Humanoid body;
    body.by_names = false;
    for (size_t side = 0; side < 2; ++side) {
      const Chain& leg = down_[at(legs.first[side])];
      const auto bones = long_bones(leg);
      if (!bones) return std::nullopt;
      for (size_t i = 0; i < 3; ++i) body.legs[side][i] = leg.joints[(*bones)[i]];
      if ((*bones)[2] + 1 < leg.joints.size()) {
        body.legs[side][kToe] = leg.joints[(*bones)[2] + 1];
      }
      find_arm(down_[at(arms.first[side])], body.arms[side]);
    }
    body.pelvis = legs.joint;
    find_trunk(skeleton_, names_, body);
    if (!missing_parts(body).empty() || !order_sides(body)) return std::nullopt;
    return body;
  }

  /// An arm without a hand ends with its elbow, whose End Site is the wrist.
  void find_arm(const Chain& chain, LimbJoints& arm) const {
    const std::optional<Vec3>& end = skeleton_.end_sites[at(chain.joints.back())];
    const auto bones = long_bones(chain);
    const double forearm = end ? end->norm() : 0;
    if (bones && (!end || chain.joints.size() > 3 || forearm < chain.bones[(*bones)[1]] * 0.6)) {
      for (size_t i = 0; i < 3; ++i) arm[i + 1] = chain.joints[(*bones)[i]];
      if ((*bones)[0] > 0) arm[kCollar] = chain.joints[(*bones)[0] - 1];
    } else if (chain.joints.size() >= 2) {
      const size_t last = chain.joints.size() - 1;
      arm[kElbow] = chain.joints[last];
      arm[kShoulder] = chain.joints[last - 1];
      if (last > 1) arm[kCollar] = chain.joints[last - 2];
    }
  }

  Side side_of(const LimbJoints& limb) const {
    for (const int joint : limb) {
      if (joint >= 0 && names_[at(joint)].side != Side::none) return names_[at(joint)].side;
    }
    return Side::none;
  }

  /// Puts the left limbs first. False if nothing tells left from right.
  bool order_sides(Humanoid& body) const {
    for (auto* limbs : {&body.legs, &body.arms}) {
      const Side first = side_of((*limbs)[0]), second = side_of((*limbs)[1]);
      if (first == second) return order_by_toes(body);
      if (first == Side::right || second == Side::left) std::swap((*limbs)[0], (*limbs)[1]);
    }
    return true;
  }

  bool order_by_toes(Humanoid& body) const {
    const SkeletonPose* pose = standing_pose(skeleton_, body);
    if (!pose) return false;
    const Vec3 up = trunk_direction(*pose, body).normalized();
    Vec3 forward = Vec3::Zero();
    double legs = 0;
    for (const LimbJoints& leg : body.legs) {
      const Vec3& ankle = pose->positions[at(leg[kAnkle])];
      legs += (ankle - pose->positions[at(leg[kHip])]).norm();
      if (leg[kToe] >= 0) {
        forward += pose->positions[at(leg[kToe])] - ankle;
      } else if (const auto& end = skeleton_.end_sites[at(leg[kAnkle])]) {
        forward += pose->rotations[at(leg[kAnkle])] * *end;
      }
    }
    forward -= up * up.dot(forward);
    if (forward.norm() < 0.05 * legs) return false;
    const Vec3 left = up.cross(forward).normalized();
    const auto order = [&](std::array<LimbJoints, 2>& limbs, size_t joint) {
      const Vec3 across =
          pose->positions[at(limbs[0][joint])] - pose->positions[at(limbs[1][joint])];
      if (across.dot(left) < 0) std::swap(limbs[0], limbs[1]);
    };
    order(body.legs, kHip);
    order(body.arms, kShoulder);
    return true;
  }

  const SkeletonView& skeleton_;
  const std::vector<NameReading>& names_;
  std::vector<std::vector<size_t>> children_;
  std::vector<Chain> down_;
};

double leg_length(const SkeletonView& skeleton, const LimbJoints& leg) {
  const std::vector<Vec3>& p = skeleton.rest.positions;
  return (p[at(leg[kHip])] - p[at(leg[kKnee])]).norm() +
         (p[at(leg[kKnee])] - p[at(leg[kAnkle])]).norm();
}

}  // namespace

Vec3 hip_centre(const SkeletonPose& pose, const Humanoid& body) {
  return (pose.positions[at(body.legs[0][kHip])] + pose.positions[at(body.legs[1][kHip])]) / 2;
}

int trunk_top(const Humanoid& body) { return body.neck >= 0 ? body.neck : body.head; }

std::optional<Humanoid> find_body_by_shape(const SkeletonView& skeleton,
                                           const std::vector<NameReading>& names) {
  return ShapeFinder(skeleton, names).find();
}

const SkeletonPose* standing_pose(const SkeletonView& skeleton, const Humanoid& body) {
  for (const SkeletonPose* pose : {&skeleton.rest, &skeleton.first}) {
    const Vec3 up = trunk_direction(*pose, body);
    if (cosine(up, leg_direction(*pose, body, 0)) < -0.5 &&
        cosine(up, leg_direction(*pose, body, 1)) < -0.5) {
      return pose;
    }
  }
  return nullptr;
}

std::string why_no_human(const SkeletonView& skeleton, const std::vector<NameReading>& names,
                         const Humanoid& body) {
  const double legs = (leg_length(skeleton, body.legs[0]) + leg_length(skeleton, body.legs[1])) / 2;
  const std::vector<Vec3>& rest = skeleton.rest.positions;
  double trunk = 0;
  Vec3 last = hip_centre(skeleton.rest, body);
  for (const int joint : body.spine) {
    trunk += (rest[at(joint)] - last).norm();
    last = rest[at(joint)];
  }
  trunk += (rest[at(trunk_top(body))] - last).norm();
  if (!(legs > 1e-9) || !(trunk > 1e-9)) return "its bones have no length";
  // A trunk that lies over four legs. People sit and bend, too, but their legs are longer.
  const bool tail =
      std::any_of(names.begin(), names.end(), [](const NameReading& name) { return name.tail; });
  const Vec3 up = trunk_direction(skeleton.first, body);
  const Vec3 down = leg_direction(skeleton.first, body, 0) + leg_direction(skeleton.first, body, 1);
  if (std::abs(cosine(up, down)) < 0.5 && legs < (tail ? 1.3 : 0.95) * trunk) {
    return "it has the build of an animal on four legs";
  }
  return "";
}

}  // namespace remomask::rig
