#pragma once

#include <optional>
#include <string>
#include <vector>

#include "remomask/motion.h"
#include "remomask/motion_file.h"

namespace remomask::formats {

/// The 22 joints as a file holds them: at its rate, in its unit and axes.
struct RawMotion {
  Motion positions;
  std::optional<Motion> rest_pose;        ///< one frame
  double fps = 0;                         ///< 0: the file states none
  std::optional<double> metres_per_unit;  ///< where the format states it
  std::optional<char> up_axis;            ///< likewise
  std::string skeleton_map;
  std::vector<std::string> warnings;
};

/// Whether load_motion() reads files of this extension.
bool is_readable_motion(const std::string& path);

/// More frames than any take has; what is read is bounded by it.
constexpr int kMaxFrames = 4'000'000;

/// Bytes of a motion file that is text, which is held beside the numbers that are read from it.
constexpr uint64_t kMaxMotionText = uint64_t{1} << 29;

/// Throws FileError if a file of so many frames is not read.
void check_frame_count(size_t frames, const std::string& path);

/// Throws Error for invalid options.
void check_reading_options(const MotionFileOptions& options);

/// Brings a motion to 20 fps, metres and Y up; to canonical form if that is asked for. What the
/// caller says goes before what the file says, and that before what its motion looks like.
LoadedMotion finish_reading(RawMotion raw, const MotionFileOptions& options);

}  // namespace remomask::formats
