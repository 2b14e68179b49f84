#include "remomask/motion_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/file.h"
#include "formats/axis_detection.h"
#include "formats/bvh.h"
#include "formats/mapped_kinematics.h"
#include "formats/motion_writing.h"
#include "formats/npy.h"
#include "motion/canonical.h"
#include "motion/features.h"
#include "remomask/error.h"
#include "rig/skeleton_choice.h"

namespace remomask::formats {

namespace {

constexpr int kJoints = 22;

void check_options(const MotionFileOptions& options) {
  if (options.metres_per_unit &&
      !(*options.metres_per_unit > 0 && std::isfinite(*options.metres_per_unit))) {
    throw Error("metres per unit must be a number above zero");
  }
  if (options.up_axis && *options.up_axis != 'X' && *options.up_axis != 'Y' &&
      *options.up_axis != 'Z') {
    throw Error(std::string("the up axis must be X, Y or Z, not \"") + *options.up_axis + "\"");
  }
  if (options.skip_frames < 0) throw Error("the number of frames to skip cannot be negative");
}

Motion skip_first(const Motion& motion, int skip) {
  if (skip >= motion.frames) {
    throw Error(fmt::format("cannot skip {} frames of {}", skip, motion.frames));
  }
  return skip == 0 ? motion : slice(motion, skip, motion.frames);
}

/// Converts raw positions at the source's rate to 20 fps, metres and Y up; canonical if requested.
void bring_to_metres(Motion raw, const Motion* rest_pose, const MotionFileOptions& options,
                     LoadedMotion& loaded) {
  loaded.source_frames = raw.frames;
  raw = skip_first(raw, options.skip_frames);
  loaded.up_axis = options.up_axis ? *options.up_axis : detect_up_axis(raw, rest_pose);
  loaded.metres_per_unit =
      options.metres_per_unit ? *options.metres_per_unit : detect_metres_per_unit(raw);
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion = motion::resample(raw, loaded.source_fps, skeleton.fps);
  for (float& value : motion.positions) {
    value = static_cast<float>(value * loaded.metres_per_unit);
  }
  turn_up_axis(motion, loaded.up_axis);
  motion::CanonicalOptions canonical;
  canonical.uniform_skeleton = !options.own_proportions;
  loaded.motion =
      options.canonical ? motion::canonicalize(motion, skeleton, canonical) : std::move(motion);
}

LoadedMotion load_bvh_motion(const std::string& path, const MotionFileOptions& options) {
  const Bvh bvh = read_bvh(path);
  const rig::ChosenSkeletonMap chosen =
      rig::choose_skeleton_map(view_of(bvh), options.skeleton_map, path);
  MappedKinematics kinematics(bvh, chosen.map);
  Motion raw(bvh.frames, kJoints), rest(1, kJoints);
  for (int t = 0; t < bvh.frames; ++t) kinematics.positions(t, raw.at(t, 0));
  kinematics.rest_positions(rest.at(0, 0));
  LoadedMotion loaded;
  loaded.skeleton_map = chosen.map.name;
  loaded.warnings = chosen.warnings;
  loaded.source_fps = 1 / bvh.frame_time;
  bring_to_metres(std::move(raw), &rest, options, loaded);
  return loaded;
}

LoadedMotion load_npy_motion(const std::string& path, const MotionFileOptions& options) {
  NpyArray array = read_npy(path);
  const Skeleton& skeleton = humanml_skeleton();
  const std::vector<size_t>& shape = array.shape;
  const auto dim = static_cast<size_t>(skeleton.feature_dim());
  const bool features = shape.size() == 2 && shape[1] == dim;
  const bool joints = shape.size() == 3 && shape[1] == kJoints && shape[2] == 3;
  if ((!features && !joints) || shape[0] < 1 || shape[0] > 10'000'000) {
    throw FileError(path, 0,
                    fmt::format("has shape ({}); frames x 22 x 3 joints or frames x {} features "
                                "are needed",
                                fmt::join(shape, ", "), dim));
  }
  Motion raw;
  if (features) {
    motion::Features rows(static_cast<int>(shape[0]), skeleton.feature_dim());
    rows.values = std::move(array.values);
    raw = motion::recover_motion(rows, skeleton);
  } else {
    raw = Motion(static_cast<int>(shape[0]), kJoints);
    raw.positions = std::move(array.values);
  }
  LoadedMotion loaded;
  loaded.source_fps = skeleton.fps;
  bring_to_metres(std::move(raw), nullptr, options, loaded);
  return loaded;
}

}  // namespace

}  // namespace remomask::formats

namespace remomask {

LoadedMotion load_motion(const std::string& path, const MotionFileOptions& options) {
  formats::check_options(options);
  const std::string extension = formats::lower_extension(path);
  try {
    if (extension == ".bvh") return formats::load_bvh_motion(path, options);
    if (extension == ".npy") return formats::load_npy_motion(path, options);
  } catch (const FileError&) {
    throw;
  } catch (const Error& error) {
    throw FileError(path, 0, error.what());
  }
  throw FileError(path, 0, "is not of a known file type; motions are read from .bvh and .npy");
}

WrittenMotion save_motion(const std::string& path, const Motion& motion,
                          const MotionWriteOptions& options) {
  return formats::write_motion(path, motion, nullptr, options);
}

}  // namespace remomask
