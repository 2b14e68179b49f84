#include "formats/amass.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/bvh_scanner.h"
#include "formats/joint_array.h"
#include "formats/npz.h"
#include "formats/smpl_rest.h"
#include "motion/rotation.h"
#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr size_t kBodyJoints = 22;
constexpr double kMaxAmassFps = 100'000;

using Names = std::vector<std::string>;

const Names kPositionNames = {"joints", "positions", "posed_joints", "joint_positions", "arr_0"};
/// Names that mean positions where a file holds none of the others.
const Names kLoosePositionNames = {"joints3d",    "joints_3d",    "j3d",       "jtr",
                                   "keypoints3d", "keypoints_3d", "keypoints", "global_positions",
                                   "motion",      "xyz"};
const Names kPoseNames = {"poses", "smpl_poses", "pose", "thetas"};
const Names kRootNames = {"root_orient", "global_orient"};
const Names kBodyNames = {"pose_body", "body_pose"};
const Names kTransNames = {"trans", "transl", "smpl_trans"};
const Names kAmassRateNames = {"mocap_framerate", "mocap_frame_rate"};
const Names kOtherRateNames = {"fps", "frame_rate", "framerate"};

Names all_npz_names() {
  Names all;
  for (const Names& names : {kPositionNames, kPoseNames, kRootNames, kBodyNames, kTransNames,
                             kAmassRateNames, kOtherRateNames}) {
    all.insert(all.end(), names.begin(), names.end());
  }
  return all;
}

/// Numbers of a row of poses: 22, 24, 52 or 55 joints, of which the first 22 are the body's.
bool is_pose_width(size_t width) {
  return width == 66 || width == 72 || width == 156 || width == 165;
}

/// An array as rows of frames. A batch of one is its only motion.
struct PoseRows {
  const NpyArray* array = nullptr;
  size_t frames = 0, width = 0;
  bool matrices = false;  ///< nine numbers a joint instead of three

  explicit PoseRows(const NpyArray* rows) : array(rows) {
    if (!rows || rows->shape.empty()) return;
    const std::vector<size_t>& shape = rows->shape;
    frames = shape[shape.size() > 2 && shape[0] == 1 ? 1 : 0];
    width = frames == 0 ? 0 : rows->values.size() / frames;
    const size_t axes = shape.size();
    matrices = axes >= 3 && shape[axes - 1] == 3 && shape[axes - 2] == 3;
  }
  const float* row(size_t frame) const { return array->values.data() + frame * width; }
  /// Numbers of a row as axis and angle.
  size_t turn_width() const { return matrices ? width / 3 : width; }
  Quat turn(size_t frame, size_t joint) const {
    const float* p = row(frame) + (matrices ? 9 : 3) * joint;
    if (!matrices) {
      const Vec3 axis(p[0], p[1], p[2]);
      const double angle = axis.norm();
      if (std::isfinite(angle) && angle < 1e-12) return Quat::Identity();
      return Quat(Eigen::AngleAxisd(angle, axis / angle));
    }
    Eigen::Matrix3d matrix;
    matrix << p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8];
    return Quat(matrix).normalized();
  }
};

/// Reads the arrays of one file into a SourceMotion.
class AmassReader {
 public:
  AmassReader(const NpzArrays& npz, const std::string& path) : npz_(npz), path_(path) {}

  AmassMotion read() {
    find_poses();
    find_rate();
    rig::SourceMotion& source = result_.source;
    const Skeleton& skeleton = humanml_skeleton();
    for (size_t j = 0; j < kBodyJoints; ++j) {
      rig::SourceJoint joint;
      joint.name = skeleton.joint_names[j];
      joint.parent = skeleton.parents[j];
      joint.offset = smpl_rest_offsets()[j];
      source.joints.push_back(joint);
    }
    source.metres_per_unit = 1;
    copy_frames();
    find_up_axis();
    warn("the shape of the body (betas) is not used: the joints are those of an average body");
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw FileError(path_, 0, message); }
  void warn(const std::string& message) {
    result_.warnings.emplace_back(FileError(path_, 0, message).what());
  }

  void find_poses() {
    poses_ = PoseRows(npz_.find_any(kPoseNames));
    root_ = PoseRows(npz_.find_any(kRootNames));
    body_ = PoseRows(npz_.find_any(kBodyNames));
    trans_ = PoseRows(npz_.find_any(kTransNames));
    // Where both are there, as in the SMPL-X files of AMASS, they say the same.
    if (root_.array && body_.array) {
      poses_ = PoseRows(nullptr);
      if (root_.turn_width() != 3 || body_.turn_width() < 63 || root_.frames != body_.frames) {
        fail(
            fmt::format("root_orient has {} x {} numbers and pose_body {} x {}; T x 3 and T x 63 "
                        "are needed",
                        root_.frames, root_.width, body_.frames, body_.width));
      }
      frames_ = root_.frames;
    } else if (poses_.array) {
      if (!is_pose_width(poses_.turn_width())) {
        fail(
            fmt::format("poses has shape ({}); T rows of 66, 72, 156 or 165 axis-angle numbers, "
                        "or of as many rotation matrices, are needed",
                        fmt::join(poses_.array->shape, ", ")));
      }
      frames_ = poses_.frames;
    } else {
      fail(
          fmt::format("holds no motion that is known, only the arrays {}; needed are poses and "
                      "trans (AMASS), root_orient and pose_body, or joints or positions",
                      shown_names()));
    }
    if (trans_.array && (trans_.width != 3 || trans_.frames != frames_)) {
      fail(fmt::format("trans has shape ({}), the poses have {} frames; T x 3 is needed",
                       fmt::join(trans_.array->shape, ", "), frames_));
    }
    if (frames_ == 0) fail("there are no frames in it");
    check_frame_count(frames_, path_);
    if (!trans_.array) warn("there is no array trans: the root stays in its place");
  }

  std::string shown_names() const {
    Names names;
    for (const std::string& name : npz_.names) {
      if (names.size() == 12) break;
      names.push_back(in_quotes(name));
    }
    return names.empty() ? "(none)" : fmt::format("{}", fmt::join(names, ", "));
  }

  void find_rate() {
    const NpyArray* rate = npz_.find_any(kAmassRateNames);
    z_is_up_ = rate != nullptr;
    if (!rate) rate = npz_.find_any(kOtherRateNames);
    if (!rate || rate->values.size() != 1) return;
    const double fps = rate->values[0];
    if (fps > 0 && fps < kMaxAmassFps) result_.source.fps = fps;
  }

  void copy_frames() {
    rig::SourceMotion& source = result_.source;
    source.frames = static_cast<int>(frames_);
    source.rotations.reserve(frames_ * kBodyJoints * 4);
    source.translations.reserve(frames_ * kBodyJoints * 3);
    for (size_t t = 0; t < frames_; ++t) {
      for (size_t j = 0; j < kBodyJoints; ++j) {
        append_rotation(t, j);
        Vec3 translation = source.joints[j].offset;
        if (j == 0 && trans_.array) {
          const float* p = trans_.row(t);
          translation = Vec3(p[0], p[1], p[2]);
          if (!translation.allFinite()) fail_at(t, "trans");
        }
        for (int axis = 0; axis < 3; ++axis) {
          source.translations.push_back(static_cast<float>(translation[axis]));
        }
      }
    }
  }

  void append_rotation(size_t frame, size_t joint) {
    const Quat rotation = poses_.array ? poses_.turn(frame, joint)
                          : joint == 0 ? root_.turn(frame, 0)
                                       : body_.turn(frame, joint - 1);
    if (!rotation.coeffs().allFinite()) fail_at(frame, "the pose");
    for (const double value : {rotation.x(), rotation.y(), rotation.z(), rotation.w()}) {
      result_.source.rotations.push_back(static_cast<float>(value));
    }
  }

  [[noreturn]] void fail_at(size_t frame, const char* what) const {
    fail(
        fmt::format("frame {}: {} is not a finite number; repair or remove the clip", frame, what));
  }

  /// AMASS is Z up. Bodies that stand along Y all the time were made by something else.
  void find_up_axis() {
    if (!z_is_up_) return;
    rig::SourceMotion& source = result_.source;
    source.up_axis = 'Z';
    double along_y = 0;
    const int step = std::max(1, source.frames / 100);
    int count = 0;
    for (int t = 0; t < source.frames; t += step, ++count) {
      const std::vector<Vec3> joints = rig::world_positions(source, t);
      along_y += (joints[15] - (joints[7] + joints[8]) / 2).normalized().y();
    }
    if (along_y < 0.9 * count) return;
    source.up_axis = 'Y';
    warn(
        "the body stands along Y, though AMASS files are Z up: Y is taken as up; --up-axis Z "
        "reads it as AMASS does");
  }

  const NpzArrays& npz_;
  const std::string& path_;
  PoseRows poses_{nullptr}, root_{nullptr}, body_{nullptr}, trans_{nullptr};
  size_t frames_ = 0;
  bool z_is_up_ = false;
  AmassMotion result_;
};

RawMotion joints_of_npz(const NpyArray& array, const NpzArrays& npz, const std::string& path) {
  RawMotion raw;
  raw.positions = motion_of_array(array, path, raw.warnings);
  const NpyArray* rate = npz.find_any(kAmassRateNames);
  if (!rate) rate = npz.find_any(kOtherRateNames);
  if (rate && rate->values.size() == 1 && rate->values[0] > 0) raw.fps = rate->values[0];
  return raw;
}

}  // namespace

AmassMotion read_amass(const std::string& path) {
  const NpzArrays npz = read_npz(path, all_npz_names());
  return AmassReader(npz, path).read();
}

RawMotion read_npz_motion(const std::string& path) {
  const NpzArrays npz = read_npz(path, all_npz_names());
  if (const NpyArray* positions = npz.find_any(kPositionNames)) {
    return joints_of_npz(*positions, npz, path);
  }
  if (!npz.find_any(kPoseNames) && !npz.find_any(kBodyNames)) {
    const NpzArrays loose = read_npz(path, kLoosePositionNames);
    if (const NpyArray* positions = loose.find_any(kLoosePositionNames)) {
      return joints_of_npz(*positions, npz, path);
    }
  }
  AmassMotion amass = AmassReader(npz, path).read();
  RawMotion raw;
  raw.positions = Motion(amass.source.frames, static_cast<int>(kBodyJoints));
  for (int t = 0; t < amass.source.frames; ++t) {
    const std::vector<Vec3> joints = rig::world_positions(amass.source, t);
    for (size_t j = 0; j < joints.size(); ++j) {
      set_joint_position(raw.positions, t, static_cast<int>(j), joints[j]);
    }
  }
  raw.fps = amass.source.fps;
  raw.metres_per_unit = amass.source.metres_per_unit;
  raw.up_axis = amass.source.up_axis;
  raw.warnings = std::move(amass.warnings);
  return raw;
}

}  // namespace remomask::formats
