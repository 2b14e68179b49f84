#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "remomask/motion.h"

namespace remomask::formats {

struct MotionFileOptions {
  std::optional<double> metres_per_unit;  ///< default: guessed from the skeleton's size
  std::optional<char> up_axis;  ///< 'X', 'Y' or 'Z'; default: found from the rest of the body
  int skip_frames = 0;          ///< frames to drop at the start (source rate)
  /// false: place, heading, floor and size of the body stay as in the file; only unit, up
  /// axis and rate are changed. What is in metres, Y up and at 20 fps is read as it is.
  bool canonical = true;
  std::string
      skeleton_map;  ///< name of a shipped map or path of a map file; empty: found by joint names
};

struct LoadedMotion {
  Motion motion;             ///< canonical unless asked for otherwise, 22 joints, 20 fps
  std::string skeleton_map;  ///< the map that was used ("" for npy)
  double source_fps = 0;
  int source_frames = 0;
  double metres_per_unit = 0;
  char up_axis = 'Y';
};

/// Reads .bvh or .npy (T x 22 x 3 joints, or T x 263 features) and brings it to
/// canonical positions at 20 fps. Throws FileError with line and remedy.
LoadedMotion load_motion_file(const std::string& path, const MotionFileOptions& options = {});

/// Text fields stored inside a written file (prompt, seed, model, evidence).
using FileMetadata = std::vector<std::pair<std::string, std::string>>;

/// Writes .bvh (bone rotations from twist-aware inverse kinematics, T-pose
/// rest, centimetres) or .npy (float32 T x 22 x 3 metres; metadata beside it as
/// PATH.json), by extension, atomically.
void save_motion_file(const std::string& path, const Motion& motion,
                      const FileMetadata& metadata = {});

}  // namespace remomask::formats
