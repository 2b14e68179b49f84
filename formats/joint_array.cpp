#include "formats/joint_array.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "formats/motion_reading.h"
#include "motion/features.h"
#include "motion/vector.h"
#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr size_t kOurJoints = 22;

using Shape = std::vector<size_t>;

/// Where the numbers of a motion are in an array.
struct JointLayout {
  size_t frames = 0, joints = 0;
  size_t frame_step = 0, joint_step = 0, axis_step = 0;  ///< in numbers
  bool flat = false;
};

/// Numbers of joints of bodies whose first 22 are ours: SMPL without hands, SMPL, SMPL-H, SMPL-X.
bool is_smpl_count(size_t joints) {
  return joints == 22 || joints == 24 || joints == 52 || joints == 55;
}

/// The same, and those that the models of these bodies put out, with points of face, hands and feet
/// behind the joints.
bool is_body_count(size_t joints) {
  return is_smpl_count(joints) || joints == 45 || joints == 73 || joints == 127 || joints == 144;
}

std::optional<JointLayout> layout_of(const Shape& shape) {
  const size_t axes = shape.size();
  if (axes == 3 && shape[2] == 3 && is_body_count(shape[1])) {
    return JointLayout{shape[0], shape[1], shape[1] * 3, 3, 1, false};
  }
  if (axes == 3 && shape[1] == 3 && is_body_count(shape[0])) {
    return JointLayout{shape[2], shape[0], 1, 3 * shape[2], shape[2], false};
  }
  // Joints or axes before frames, as transposed arrays have them.
  if (axes == 3 && shape[2] == 3 && is_body_count(shape[0])) {
    return JointLayout{shape[1], shape[0], 3, 3 * shape[1], 1, false};
  }
  if (axes == 3 && shape[1] == 3 && is_body_count(shape[2])) {
    return JointLayout{shape[0], shape[2], 3 * shape[2], 1, shape[2], false};
  }
  if (axes == 2 && shape[1] % 3 == 0 && is_smpl_count(shape[1] / 3)) {
    return JointLayout{shape[0], shape[1] / 3, shape[1], 3, 1, true};
  }
  if (axes == 2 && shape[1] == 3 && is_smpl_count(shape[0])) {
    return JointLayout{1, shape[0], shape[0] * 3, 3, 1, false};
  }
  return std::nullopt;
}

bool is_features(const Shape& shape) {
  return shape.size() == 2 && shape[1] == static_cast<size_t>(humanml_skeleton().feature_dim());
}

[[noreturn]] void refuse_shape(const Shape& shape, const std::string& name) {
  const std::string shown = fmt::format("has shape ({})", fmt::join(shape, ", "));
  const Shape rest(shape.empty() ? shape.end() : shape.begin() + 1, shape.end());
  if (shape.size() >= 3 && shape[0] > 1 && (layout_of(rest) || is_features(rest))) {
    throw FileError(name, 0,
                    fmt::format("{}: these are {} motions; save them one a file: array[0], "
                                "array[1], ...",
                                shown, shape[0]));
  }
  if (shape.size() >= 2 && (shape[1] == 21 || shape[1] == 251)) {
    throw FileError(name, 0,
                    shown +
                        ": this is a motion of KIT-ML; import the data set's folder with "
                        "new_joint_vecs and texts");
  }
  throw FileError(
      name, 0,
      shown +
          "; accepted are joint positions (T, 22, 3), (T, 66), (1, T, 22, 3), (22, 3, T) and "
          "(1, 22, 3, T), the same with the 24, 52 or 55 joints of SMPL, SMPL-H and SMPL-X or the "
          "45, 73, 127 or 144 points of these models, and features (T, 263)");
}

void require_finite_joints(const Motion& motion, const std::string& name) {
  for (int t = 0; t < motion.frames; ++t) {
    for (int j = 0; j < motion.joints; ++j) {
      if (joint_position(motion, t, j).allFinite()) continue;
      throw FileError(name, 0,
                      fmt::format("frame {}, joint {}: the position is not a finite number; repair "
                                  "or remove the clip",
                                  t, humanml_skeleton().joint_names[static_cast<size_t>(j)]));
    }
  }
}

/// Whether the bone that ends in `joint` keeps about its length.
bool is_bone(const Motion& motion, int parent, int joint, double& mean) {
  double sum = 0, squares = 0;
  for (int t = 0; t < motion.frames; ++t) {
    const double length =
        (joint_position(motion, t, joint) - joint_position(motion, t, parent)).norm();
    sum += length;
    squares += length * length;
  }
  mean = sum / motion.frames;
  const double variance = squares / motion.frames - mean * mean;
  return mean > 1e-9 && variance < 0.0625 * mean * mean;
}

/// Whether the joints 1, 4, 7 and 2, 5, 8 are two legs, as in SMPL.
bool has_legs(const Motion& motion) {
  double thigh = 0, shin = 0;
  for (const int side : {1, 2}) {
    if (!is_bone(motion, side, side + 3, thigh) || !is_bone(motion, side + 3, side + 6, shin)) {
      return false;
    }
    if (!(shin > 0.5 * thigh && shin < 2 * thigh)) return false;
  }
  return true;
}

Motion copy_joints(const NpyArray& array, const JointLayout& layout) {
  Motion motion(static_cast<int>(layout.frames), static_cast<int>(kOurJoints));
  float* out = motion.positions.data();
  for (size_t t = 0; t < layout.frames; ++t) {
    for (size_t j = 0; j < kOurJoints; ++j) {
      const size_t place = t * layout.frame_step + j * layout.joint_step;
      for (size_t axis = 0; axis < 3; ++axis)
        *out++ = array.values[place + axis * layout.axis_step];
    }
  }
  return motion;
}

/// Features as MDM stores them, with frames last, frames first.
NpyArray transposed(const NpyArray& array) {
  const size_t rows = array.shape[1], columns = array.shape[0];
  NpyArray result{{rows, columns}, std::vector<float>(array.values.size())};
  for (size_t i = 0; i < rows; ++i) {
    for (size_t j = 0; j < columns; ++j) {
      result.values[i * columns + j] = array.values[j * rows + i];
    }
  }
  return result;
}

Motion motion_of_features(NpyArray array, const std::string& name) {
  const Skeleton& skeleton = humanml_skeleton();
  check_frame_count(array.shape[0], name);
  motion::Features rows(static_cast<int>(array.shape[0]), skeleton.feature_dim());
  rows.values = std::move(array.values);
  return motion::recover_motion(rows, skeleton);
}

}  // namespace

Motion motion_of_array(NpyArray array, const std::string& name,
                       std::vector<std::string>& warnings) {
  const Shape original = array.shape;
  // A batch of one is the motion itself, wherever its axis stands.
  for (auto one = array.shape.begin(); one != array.shape.end() && array.shape.size() > 2;) {
    if (layout_of(array.shape)) break;
    one = *one == 1 ? array.shape.erase(one) : one + 1;
  }
  if (std::find(original.begin(), original.end(), size_t{0}) != original.end()) {
    throw FileError(name, 0,
                    fmt::format("has shape ({}): there are no frames", fmt::join(original, ", ")));
  }
  if (array.shape.size() == 2 && is_features({array.shape[1], array.shape[0]}) &&
      original.size() > 2) {
    array = transposed(array);
  }
  if (is_features(array.shape)) return motion_of_features(std::move(array), name);
  const std::optional<JointLayout> layout = layout_of(array.shape);
  if (!layout) refuse_shape(original, name);
  check_frame_count(layout->frames, name);
  Motion motion = copy_joints(array, *layout);
  require_finite_joints(motion, name);
  if ((layout->flat || layout->joints != kOurJoints) && !has_legs(motion)) {
    throw FileError(
        name, 0,
        fmt::format(
            "has shape ({}), but its numbers are not positions of {} joints in the order of "
            "SMPL: the legs change their length. Save pose parameters as an .npz file with "
            "poses, trans and mocap_framerate, positions as (T, 22, 3)",
            fmt::join(original, ", "), layout->joints));
  }
  if (layout->joints != kOurJoints) {
    warnings.emplace_back(FileError(name, 0,
                                    fmt::format("of its {} joints the first {} are used, in the "
                                                "order of SMPL",
                                                layout->joints, kOurJoints))
                              .what());
  }
  return motion;
}

}  // namespace remomask::formats
