#include "scenes/node_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "remomask/error.h"

namespace remomask::scenes {

namespace {

/// Frames times joints that a file may expand to; ten hours of a rich skeleton.
constexpr double kMaxJointFrames = 60'000'000;

Quat to_quat(const Eigen::Vector4d& v) {
  const Quat q(v[3], v[0], v[1], v[2]);
  return q.norm() > 1e-9 ? q.normalized() : Quat::Identity();
}

/// Places and turns of all joints for transforms with scales: positions are exact, and scales stay
/// out of the rotations.
class PoseWriter {
 public:
  explicit PoseWriter(const std::vector<rig::SourceJoint>& joints)
      : joints_(joints), linear_(joints.size()), turns_(joints.size()), places_(joints.size()) {}

  void solve(const std::vector<NodeTransform>& local) {
    for (size_t j = 0; j < joints_.size(); ++j) {
      const auto parent = static_cast<size_t>(std::max(joints_[j].parent, 0));
      const bool root = joints_[j].parent < 0;
      const NodeTransform& own = local[j];
      const Eigen::Matrix3d scaled = own.rotation.toRotationMatrix() * own.scale.asDiagonal();
      linear_[j] = root ? scaled : Eigen::Matrix3d(linear_[parent] * scaled);
      turns_[j] = root ? own.rotation : turns_[parent] * own.rotation;
      places_[j] =
          root ? own.translation : Vec3(places_[parent] + linear_[parent] * own.translation);
    }
  }

  /// From the parent, in the parent's axes without its scale.
  Vec3 translation(size_t j) const {
    if (joints_[j].parent < 0) return places_[j];
    const auto parent = static_cast<size_t>(joints_[j].parent);
    return turns_[parent].conjugate() * (places_[j] - places_[parent]);
  }

 private:
  const std::vector<rig::SourceJoint>& joints_;
  std::vector<Eigen::Matrix3d> linear_;
  std::vector<Quat> turns_;
  std::vector<Vec3> places_;
};

}  // namespace

Eigen::Vector4d NodeTrack::value_at(double time) const {
  const size_t width = property == Property::rotation ? 4 : 3;
  const bool cubic = interpolation == Interpolation::cubic_spline;
  const auto value = [&](size_t key, size_t part) {
    Eigen::Vector4d result = Eigen::Vector4d::Zero();
    const float* from = values.data() + (cubic ? key * 3 + part : key) * width;
    for (size_t k = 0; k < width; ++k) result[static_cast<Eigen::Index>(k)] = from[k];
    return result;
  };
  constexpr size_t kIn = 0, kValue = 1, kOut = 2;
  // Keys have times in float: a frame that falls on a key misses it by their rounding, and would
  // show the pose before a step.
  constexpr double kRounding = 1e-6;
  const double reached = time + kRounding * std::max(1.0, std::abs(time));
  const auto after = std::upper_bound(times.begin(), times.end(), reached,
                                      [](double t, float key) { return t < key; });
  if (after == times.begin()) return value(0, kValue);
  const auto key = static_cast<size_t>(after - times.begin()) - 1;
  if (key + 1 == times.size() || interpolation == Interpolation::step) return value(key, kValue);
  const double length = static_cast<double>(times[key + 1]) - times[key];
  const double s = std::max(0.0, time - times[key]) / length;
  const Eigen::Vector4d from = value(key, kValue), to = value(key + 1, kValue);
  if (cubic) {
    const double s2 = s * s, s3 = s2 * s;
    return (2 * s3 - 3 * s2 + 1) * from + length * (s3 - 2 * s2 + s) * value(key, kOut) +
           (3 * s2 - 2 * s3) * to + length * (s3 - s2) * value(key + 1, kIn);
  }
  if (property == Property::rotation) return to_quat(from).slerp(s, to_quat(to)).coeffs();
  return from + s * (to - from);
}

void NodeTrack::apply(double time, NodeTransform& transform) const {
  const Eigen::Vector4d value = value_at(time);
  if (property == Property::rotation) {
    transform.rotation = to_quat(value);
  } else if (property == Property::scale) {
    transform.scale = value.head<3>();
  } else {
    transform.translation = value.head<3>();
  }
}

double NodeTimeline::key_rate() const {
  constexpr double kDefault = 30, kSparse = 10, kFastest = 480;
  const NodeTrack* densest = nullptr;
  for (const NodeTrack& track : tracks) {
    if (!densest || track.times.size() > densest->times.size()) densest = &track;
  }
  if (!densest || densest->times.size() < 3) return kDefault;
  std::vector<double> steps;
  for (size_t i = 1; i < densest->times.size(); ++i) {
    steps.push_back(static_cast<double>(densest->times[i]) - densest->times[i - 1]);
  }
  std::nth_element(steps.begin(), steps.begin() + static_cast<long>(steps.size() / 2), steps.end());
  // The median says which rate it is; the mean over all keys gives it exactly.
  const double median = steps[steps.size() / 2];
  const double mean = (densest->times.back() - densest->times.front()) /
                      static_cast<double>(densest->times.size() - 1);
  if (!(median > 0)) return kDefault;
  double rate = 1 / (std::abs(mean - median) < 0.01 * median ? mean : median);
  if (rate < kSparse) return kDefault;
  if (std::abs(rate - std::round(rate)) < 0.01) rate = std::round(rate);
  return std::min(rate, kFastest);
}

void set_rest(const std::vector<NodeTransform>& rest, rig::SourceMotion& motion) {
  PoseWriter pose(motion.joints);
  pose.solve(rest);
  for (size_t j = 0; j < rest.size(); ++j) {
    motion.joints[j].rotation = rest[j].rotation;
    motion.joints[j].offset = pose.translation(j);
  }
}

void add_frames(const NodeTimeline& timeline, const std::vector<int>& joint_of,
                const std::vector<NodeTransform>& rest, rig::SourceMotion& motion) {
  motion.fps = timeline.key_rate();
  const double frames = std::floor((timeline.end - timeline.begin) * motion.fps + 0.5) + 1;
  if (!(frames * static_cast<double>(rest.size()) < kMaxJointFrames)) {
    throw Error(fmt::format("has an animation of {:g} s, too long for {} joints",
                            timeline.end - timeline.begin, rest.size()));
  }
  motion.frames = static_cast<int>(frames);
  PoseWriter pose(motion.joints);
  std::vector<NodeTransform> local = rest;
  motion.rotations.reserve(static_cast<size_t>(motion.frames) * rest.size() * 4);
  motion.translations.reserve(static_cast<size_t>(motion.frames) * rest.size() * 3);
  for (int t = 0; t < motion.frames; ++t) {
    for (const NodeTrack& track : timeline.tracks) {
      const int joint = joint_of[static_cast<size_t>(track.node)];
      if (joint >= 0) {
        track.apply(timeline.begin + t / motion.fps, local[static_cast<size_t>(joint)]);
      }
    }
    pose.solve(local);
    for (size_t j = 0; j < rest.size(); ++j) {
      const Quat turn = local[j].rotation;
      const Vec3 place = pose.translation(j);
      for (const double value : {turn.x(), turn.y(), turn.z(), turn.w()}) {
        motion.rotations.push_back(static_cast<float>(value));
      }
      for (int axis = 0; axis < 3; ++axis) {
        motion.translations.push_back(static_cast<float>(place[axis]));
      }
    }
  }
}

}  // namespace remomask::scenes
