#include "formats/motion_reading.h"

#include <fmt/format.h>

#include <cmath>

#include "formats/axis_detection.h"
#include "formats/rest_frame.h"
#include "motion/canonical.h"
#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr double kMinFps = 0.1, kMaxFps = 100'000;

Motion without_first(const Motion& motion, int skip) {
  if (skip >= motion.frames) {
    throw Error(fmt::format("cannot skip {} frames of {}", skip, motion.frames));
  }
  return skip == 0 ? motion : slice(motion, skip, motion.frames);
}

}  // namespace

void check_frame_count(size_t frames, const std::string& path) {
  if (frames > static_cast<size_t>(kMaxFrames)) {
    throw FileError(path, 0,
                    fmt::format("holds {} frames, at most {} are read; cut it into shorter clips",
                                frames, kMaxFrames));
  }
}

void check_reading_options(const MotionFileOptions& options) {
  if (options.metres_per_unit &&
      !(*options.metres_per_unit > 0 && std::isfinite(*options.metres_per_unit))) {
    throw Error("metres per unit must be a number above zero");
  }
  if (options.up_axis && *options.up_axis != 'X' && *options.up_axis != 'Y' &&
      *options.up_axis != 'Z') {
    throw Error(std::string("the up axis must be X, Y or Z, not \"") + *options.up_axis + "\"");
  }
  if (options.skip_frames < 0) throw Error("the number of frames to skip cannot be negative");
  if (options.fps && !(*options.fps >= kMinFps && *options.fps <= kMaxFps)) {
    throw Error(fmt::format("the frame rate must be {:g} to {:g} frames a second, not {:g}",
                            kMinFps, kMaxFps, *options.fps));
  }
}

LoadedMotion finish_reading(RawMotion raw, const MotionFileOptions& options) {
  LoadedMotion loaded;
  loaded.skeleton_map = std::move(raw.skeleton_map);
  loaded.warnings = std::move(raw.warnings);
  loaded.source_fps = options.fps.value_or(raw.fps);
  loaded.source_frames = raw.positions.frames;
  int skipped = options.skip_frames;
  // Our own files begin with the motion, even where it begins in a T-pose.
  if (skipped == 0 && raw.rest_pose && loaded.skeleton_map != "remomask") {
    skipped = count_rest_frames(raw.positions, *raw.rest_pose, loaded.source_fps);
    if (skipped == 1) loaded.warnings.emplace_back("the first frame is a rest pose: left out");
    if (skipped > 1) {
      loaded.warnings.push_back(fmt::format(
          "the first frame is a rest pose and blends into the motion: {} frames left out",
          skipped));
    }
  }
  const Motion kept = without_first(raw.positions, skipped);
  const std::optional<char> up_axis = options.up_axis ? options.up_axis : raw.up_axis;
  loaded.up_axis =
      up_axis ? *up_axis : detect_up_axis(kept, raw.rest_pose ? &*raw.rest_pose : nullptr);
  const std::optional<double> unit =
      options.metres_per_unit ? options.metres_per_unit : raw.metres_per_unit;
  loaded.metres_per_unit = unit ? *unit : detect_metres_per_unit(kept);
  const Skeleton& skeleton = humanml_skeleton();
  Motion motion = motion::resample(kept, loaded.source_fps, skeleton.fps);
  for (float& value : motion.positions) {
    value = static_cast<float>(value * loaded.metres_per_unit);
  }
  turn_up_axis(motion, loaded.up_axis);
  motion::CanonicalOptions canonical;
  canonical.uniform_skeleton = !options.own_proportions;
  loaded.motion =
      options.canonical ? motion::canonicalize(motion, skeleton, canonical) : std::move(motion);
  return loaded;
}

}  // namespace remomask::formats
