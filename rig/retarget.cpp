#include "rig/retarget.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kinematics/pose_fit.h"
#include "motion/rotation.h"
#include "remomask/error.h"
#include "remomask/skeleton.h"
#include "rig/forward_kinematics.h"
#include "rig/skeleton_view.h"

namespace remomask::rig {

namespace {

enum FigurePoint : size_t {
  kPartPelvis = 0,
  kPartNeck = 12,
  kPartLeftShoulder = 16,
  kPartRightShoulder = 17,
};

struct FigureLimb {
  size_t upper, middle, end, tip;
};
constexpr FigureLimb kLegs[] = {{1, 4, 7, 10}, {2, 5, 8, 11}};
constexpr size_t kArms[][3] = {{16, 18, 20}, {17, 19, 21}};

/// Without these there is no body to move.
constexpr size_t kNeeded[] = {0, 1, 2, 4, 5, 7, 8, 16, 17, 18, 19};

constexpr size_t kTrunk[] = {3, 6, 9, 12, 15, 13, 14};

/// The lowest joint that both hang from; -1 if none.
int joint_above(const SkeletonView& rig, int a, int b) {
  const std::vector<int> of_b = rig.path_to_root(b);
  for (const int joint : rig.path_to_root(a)) {
    const bool shared = std::find(of_b.begin(), of_b.end(), joint) != of_b.end();
    if (shared && joint != a && joint != b) return joint;
  }
  return -1;
}

/// The nearest of the 24 turns that map axes to axes: a rig that leans a little keeps its lean.
Quat nearest_axes(const Vec3& left, const Vec3& up) {
  const auto snap = [](const Vec3& v, int taken) {
    int axis = taken == 0 ? 1 : 0;
    for (int i = 0; i < 3; ++i) {
      if (i != taken && std::abs(v[i]) > std::abs(v[axis])) axis = i;
    }
    Vec3 result = Vec3::Zero();
    result[axis] = v[axis] < 0 ? -1 : 1;
    return std::pair(result, axis);
  };
  const auto [y, up_axis] = snap(up, -1);
  const auto [x, unused] = snap(left, up_axis);
  Eigen::Matrix3d axes;
  axes << x, y, x.cross(y);
  return Quat(axes);
}

class Retargeter {
 public:
  Retargeter(const JointRotations& motion, const SourceMotion& rig, const BodyJoints& body)
      : motion_(motion), rig_(rig), body_(body), rest_(view_of(rig).rest) {
    find_axes();
    measure();
    correct_directions();
    part_of_.assign(rig.joints.size(), -1);
    for (size_t part = 0; part < body.size(); ++part) {
      if (body[part] >= 0) part_of_[static_cast<size_t>(body[part])] = static_cast<int>(part);
    }
  }

  SourceMotion run(const kinematics::FootContacts& contacts) {
    SourceMotion result = rig_;
    result.frames = motion_.frames;
    result.fps = motion_.fps;
    result.rotations.clear();
    result.translations.clear();
    std::vector<SkeletonPose> poses;
    std::vector<WorldPose> sources;
    for (int t = 0; t < motion_.frames; ++t) {
      sources.push_back(world_pose(motion_, t));
      poses.push_back(turned(sources.back()));
    }
    for (size_t side = 0; side < 2; ++side) {
      const std::vector<Vec3> shifts = still_toes(poses, sources, contacts, side);
      for (size_t t = 0; t < poses.size(); ++t) {
        place_foot(poses[t], sources[t], kLegs[side], shifts[t]);
      }
    }
    for (const SkeletonPose& pose : poses) store(pose, result);
    return result;
  }

 private:
  const Vec3& rest_place(size_t part) const {
    return rest_.positions[static_cast<size_t>(body_[part])];
  }
  double up(const Vec3& place) const { return place.dot(axes_ * Vec3::UnitY()); }

  void find_axes() {
    const size_t top = body_[kPartNeck] >= 0 ? kPartNeck : kPartLeftShoulder;
    const Vec3 left = rest_place(1) - rest_place(2) + rest_place(kPartLeftShoulder) -
                      rest_place(kPartRightShoulder);
    const Vec3 hips = (rest_place(1) + rest_place(2)) / 2;
    const Vec3 shoulders = (rest_place(kPartLeftShoulder) + rest_place(kPartRightShoulder)) / 2;
    axes_ = nearest_axes(left, (top == kPartNeck ? rest_place(top) : shoulders) - hips);
  }

  /// Rest position of a source joint; the T-pose has no rotations.
  Vec3 source_rest(size_t part) const {
    Vec3 place = Vec3::Zero();
    for (int j = static_cast<int>(part); j >= 0; j = motion_.parents[static_cast<size_t>(j)]) {
      place += to_vec(motion_.rest_offsets[static_cast<size_t>(j)]);
    }
    return place;
  }

  void measure() {
    double own = 0, theirs = 0, own_ankle = 0, their_ankle = 0;
    double lowest = INFINITY, highest = -INFINITY;
    for (const Vec3& place : rest_.positions) {
      lowest = std::min(lowest, up(place));
      highest = std::max(highest, up(place));
    }
    for (const FigureLimb& leg : kLegs) {
      own += (source_rest(leg.upper) - source_rest(leg.middle)).norm() +
             (source_rest(leg.middle) - source_rest(leg.end)).norm();
      theirs += (rest_place(leg.upper) - rest_place(leg.middle)).norm() +
                (rest_place(leg.middle) - rest_place(leg.end)).norm();
      own_ankle += source_rest(leg.end).y() / 2;
      their_ankle += up(rest_place(leg.end)) / 2;
    }
    if (!(theirs > 0)) throw Error("the legs of the character have no length");
    scale_ = theirs / own;
    // Most rigs stand on the ground. Others hang from their pelvis: their lowest joint is a toe.
    constexpr double kAbove = 0.1, kBelow = 0.02;
    const double height = highest - lowest;
    const bool stands = lowest < kAbove * height && lowest > -kBelow * height;
    floor_ = stands ? 0 : lowest;
    ankle_ = their_ankle - floor_;
    source_ankle_ = own_ankle;
  }

  /// Sets, for every part, the turn that takes the rig's rest pose to the T-pose.
  void correct_directions() {
    corrections_.fill(Quat::Identity());
    const auto along = [&](size_t from, size_t to, const Quat& so_far) {
      const Vec3 theirs = so_far * (rest_place(to) - rest_place(from));
      const Vec3 ours = axes_ * (source_rest(to) - source_rest(from));
      return (motion::shortest_arc(theirs, ours) * so_far).normalized();
    };
    for (const auto& arm : kArms) {
      corrections_[arm[0]] = along(arm[0], arm[1], Quat::Identity());
      corrections_[arm[1]] =
          body_[arm[2]] >= 0 ? along(arm[1], arm[2], corrections_[arm[0]]) : corrections_[arm[0]];
      corrections_[arm[2]] = corrections_[arm[1]];
    }
    const Vec3 vertical = axes_ * Vec3::UnitY();
    for (const FigureLimb& leg : kLegs) {
      corrections_[leg.upper] = along(leg.upper, leg.middle, Quat::Identity());
      corrections_[leg.middle] = along(leg.middle, leg.end, corrections_[leg.upper]);
      if (body_[leg.tip] < 0) continue;
      // A foot rests flat in both, whatever the legs do: only where it points is corrected.
      const auto flat = [&](const Vec3& v) { return Vec3(v - vertical * v.dot(vertical)); };
      const Quat yaw =
          motion::shortest_arc(flat(rest_place(leg.tip) - rest_place(leg.end)),
                               flat(axes_ * (source_rest(leg.tip) - source_rest(leg.end))));
      corrections_[leg.end] = corrections_[leg.tip] = yaw;
    }
  }

  /// The rig with the source's directions, its hips over the source's, scaled.
  SkeletonPose turned(const WorldPose& source) const {
    SkeletonPose pose;
    const size_t count = rig_.joints.size();
    pose.positions.resize(count);
    pose.rotations.resize(count);
    for (size_t j = 0; j < count; ++j) {
      const SourceJoint& joint = rig_.joints[j];
      const bool root = joint.parent < 0;
      const auto parent = static_cast<size_t>(std::max(joint.parent, 0));
      pose.rotations[j] = root ? joint.rotation : pose.rotations[parent] * joint.rotation;
      if (part_of_[j] >= 0) {
        const auto part = static_cast<size_t>(part_of_[j]);
        pose.rotations[j] = (axes_ * source.rotations[part] * axes_.conjugate() *
                             corrections_[part] * rest_.rotations[j])
                                .normalized();
      }
      pose.positions[j] =
          root ? joint.offset
               : Vec3(pose.positions[parent] + pose.rotations[parent] * joint.offset);
      if (part_of_[j] == kPartPelvis) pose.positions[j] = pelvis_place(source, pose.rotations[j]);
    }
    return pose;
  }

  Vec3 pelvis_place(const WorldPose& source, const Quat& turn) const {
    const Vec3 own = (source.positions[1] + source.positions[2]) / 2;
    const Vec3 goal =
        axes_ * Vec3(scale_ * own.x(), scale_ * (own.y() - source_ankle_) + ankle_ + floor_,
                     scale_ * own.z());
    const auto pelvis = static_cast<size_t>(body_[kPartPelvis]);
    const Vec3 hips = (rest_place(1) + rest_place(2)) / 2 - rest_.positions[pelvis];
    return goal - turn * (rest_.rotations[pelvis].conjugate() * hips);
  }

  /// What each frame's foot moves over the ground so that its toe, while it stands, moves as the
  /// source's does: not at all where that stands still. The correction fades in and out around a
  /// contact.
  std::vector<Vec3> still_toes(const std::vector<SkeletonPose>& poses,
                               const std::vector<WorldPose>& sources,
                               const kinematics::FootContacts& contacts, size_t side) const {
    const size_t part = body_[kLegs[side].tip] >= 0 ? kLegs[side].tip : kLegs[side].end;
    const Vec3 vertical = axes_ * Vec3::UnitY();
    const auto drift = [&](size_t t) {
      return Vec3(poses[t].positions[static_cast<size_t>(body_[part])] -
                  axes_ * (scale_ * sources[t].positions[part]));
    };
    std::vector<Vec3> shifts(poses.size(), Vec3::Zero());
    std::vector<double> weights(poses.size(), 0);
    constexpr size_t kFade = 4;
    const size_t frames = std::min(poses.size(), contacts.size());
    for (size_t first = 0; first < frames;) {
      size_t end = first;
      Vec3 mean = Vec3::Zero();
      while (end < frames && contacts[end][side]) {
        mean += drift(end++);
      }
      if (end == first) {
        ++first;
        continue;
      }
      mean /= static_cast<double>(end - first);
      const auto shift_at = [&](size_t t) {
        const Vec3 shift = mean - drift(t);
        return Vec3(shift - vertical * shift.dot(vertical));
      };
      for (size_t t = first; t < end; ++t) shifts[t] = shift_at(t);
      for (size_t k = 1; k <= kFade; ++k) {
        const double weight = 1 - static_cast<double>(k) / (kFade + 1);
        const auto fade = [&](size_t t, size_t border) {
          if (contacts[t][side] || weight <= weights[t]) return;
          weights[t] = weight;
          shifts[t] = weight * shift_at(border);
        };
        if (first >= k) fade(first - k, first);
        if (end - 1 + k < frames) fade(end - 1 + k, end - 1);
      }
      first = end;
    }
    return shifts;
  }

  void place_foot(SkeletonPose& pose, const WorldPose& source, const FigureLimb& leg,
                  const Vec3& shift) const {
    const auto at = [&](size_t part) { return static_cast<size_t>(body_[part]); };
    const Vec3 vertical = axes_ * Vec3::UnitY();
    const Vec3 hip = pose.positions[at(leg.upper)], knee = pose.positions[at(leg.middle)],
               ankle = pose.positions[at(leg.end)];
    const double height =
        floor_ + ankle_ + scale_ * (source.positions[leg.end].y() - source_ankle_);
    Vec3 goal = ankle + shift + vertical * (height - up(ankle));
    const Vec3 bent =
        kinematics::bend_joint(hip, goal, knee, (knee - hip).norm(), (ankle - knee).norm());
    const Quat foot = pose.rotations[at(leg.end)];
    const Quat toe = body_[leg.tip] >= 0 ? pose.rotations[at(leg.tip)] : foot;
    const Quat thigh = motion::shortest_arc(knee - hip, bent - hip);
    const Quat shin = motion::shortest_arc(thigh * (ankle - knee), goal - bent) * thigh;
    pose.rotations[at(leg.upper)] = (thigh * pose.rotations[at(leg.upper)]).normalized();
    pose.rotations[at(leg.middle)] = (shin * pose.rotations[at(leg.middle)]).normalized();
    follow(pose, at(leg.upper), leg, foot, toe);
  }

  /// Moves what hangs from a leg after its turns; foot and toes keep their direction.
  void follow(SkeletonPose& pose, size_t top, const FigureLimb& leg, const Quat& foot,
              const Quat& toe) const {
    std::vector<bool> below(rig_.joints.size(), false);
    below[top] = true;
    for (size_t j = top + 1; j < rig_.joints.size(); ++j) {
      const SourceJoint& joint = rig_.joints[j];
      if (joint.parent < 0 || !below[static_cast<size_t>(joint.parent)]) continue;
      const auto parent = static_cast<size_t>(joint.parent);
      below[j] = true;
      pose.positions[j] = pose.positions[parent] + pose.rotations[parent] * joint.offset;
      const int part = part_of_[j];
      if (part == static_cast<int>(leg.end)) {
        pose.rotations[j] = foot;
      } else if (part == static_cast<int>(leg.tip)) {
        pose.rotations[j] = toe;
      } else if (part != static_cast<int>(leg.middle)) {
        pose.rotations[j] = pose.rotations[parent] * joint.rotation;
      }
    }
  }

  void store(const SkeletonPose& pose, SourceMotion& result) const {
    for (size_t j = 0; j < rig_.joints.size(); ++j) {
      const int above = rig_.joints[j].parent;
      const auto parent = static_cast<size_t>(std::max(above, 0));
      const Quat turn =
          (above < 0 ? pose.rotations[j] : pose.rotations[parent].conjugate() * pose.rotations[j])
              .normalized();
      const Vec3 place = above < 0 ? pose.positions[j]
                                   : Vec3(pose.rotations[parent].conjugate() *
                                          (pose.positions[j] - pose.positions[parent]));
      for (const double value : {turn.x(), turn.y(), turn.z(), turn.w()}) {
        result.rotations.push_back(static_cast<float>(value));
      }
      for (int axis = 0; axis < 3; ++axis) {
        result.translations.push_back(static_cast<float>(place[axis]));
      }
    }
  }

  const JointRotations& motion_;
  const SourceMotion& rig_;
  const BodyJoints& body_;
  SkeletonPose rest_;
  Quat axes_;                         ///< from our axes to the rig's
  std::array<Quat, 22> corrections_;  ///< in the rig's axes
  std::vector<int> part_of_;          ///< of every joint of the rig; -1: none of the 22
  double scale_ = 1;                  ///< rig units a metre of path
  double floor_ = 0, ankle_ = 0;      ///< rig units; the ankle's height over the floor at rest
  double source_ankle_ = 0;           ///< metres
};

}  // namespace

BodyJoints body_joints(const SkeletonMap& map, const SkeletonView& rig) {
  BodyJoints body;
  body.fill(-1);
  const std::array<PlacedPoint, 22> points = place_points(map, rig);
  std::vector<bool> used(rig.size(), false);
  const auto take = [&](size_t part, int joint) {
    if (body[part] >= 0 || joint < 0 || used[static_cast<size_t>(joint)]) return;
    body[part] = joint;
    used[static_cast<size_t>(joint)] = true;
  };
  const auto as_joint = [](const PlacedPoint& point) {
    if (point.weight == 0) return point.from;
    const bool whole = point.from == point.to || point.weight == 1;
    return point.offset.isZero() && whole ? point.to : -1;
  };
  take(kPartPelvis, as_joint(points[0]));
  // A pelvis between two joints is moved by the one that both hang from.
  take(kPartPelvis, joint_above(rig, points[1].from, points[2].from));
  for (size_t part = 1; part < body.size(); ++part) take(part, as_joint(points[part]));
  // A trunk with fewer joints than ours, or with more, bends where it has joints.
  for (const size_t part : kTrunk) {
    const PlacedPoint& point = points[part];
    if (point.offset.isZero()) take(part, point.weight < 0.5 ? point.from : point.to);
  }
  for (const size_t part : kNeeded) {
    if (body[part] < 0) {
      throw Error(fmt::format("the character has no joint of its own for the {}",
                              humanml_skeleton().joint_names[part]));
    }
  }
  return body;
}

SourceMotion retarget(const JointRotations& motion, const SourceMotion& rig, const BodyJoints& body,
                      const kinematics::FootContacts& contacts) {
  return Retargeter(motion, rig, body).run(contacts);
}

}  // namespace remomask::rig
