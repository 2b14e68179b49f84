#pragma once

#include <optional>
#include <string>
#include <vector>

#include "remomask/export.h"
#include "remomask/generation.h"
#include "remomask/motion.h"

namespace remomask {

struct MotionFileOptions {
  std::optional<double> metres_per_unit;  ///< unset: guessed from the size of the skeleton
  std::optional<char> up_axis;  ///< 'X', 'Y' or 'Z'; unset: found from the rest of the body
  int skip_frames = 0;          ///< frames to drop at the start, at the file's rate
  /// Frames a second of the file; unset: what the file states. For files that state a wrong rate
  /// or none.
  std::optional<double> fps;
  /// Name of the root joint of the skeleton to read, for files that hold several.
  std::string root;
  /// false: place, heading, floor and size of the body stay as in the file; only unit, up axis
  /// and frame rate change. What is in metres, Y up and at 20 fps is then read as it is.
  bool canonical = true;
  /// Name of a shipped skeleton map or path of a map file; empty: found by joint names.
  std::string skeleton_map;
};

struct LoadedMotion {
  Motion motion;             ///< 22 joints at 20 fps, canonical unless asked for otherwise
  std::string skeleton_map;  ///< the map that was used; empty for .npy
  double source_fps = 0;
  int source_frames = 0;
  double metres_per_unit = 0;
  char up_axis = 'Y';
  /// What was odd about the file and how it was read all the same: "PATH:LINE: sentence".
  std::vector<std::string> warnings;
};

/// Reads a motion file by its extension: .bvh, .amc with its .asf, .npy and .npz (joints, features
/// or AMASS poses). Throws FileError with the line and a remedy.
REMOMASK_API LoadedMotion load_motion(const std::string& path,
                                      const MotionFileOptions& options = {});

/// Writes .bvh (joint rotations over a T-pose, centimetres) or .npy (float32 T x 22 x 3, metres),
/// chosen by extension. The file is replaced atomically, and an old sidecar is removed.
REMOMASK_API void save_motion(const std::string& path, const Motion& motion);

/// The same, and beside it PATH.json with the sentence, seed, evidence and settings that the
/// motion was made with (docs/schema/motion.json).
REMOMASK_API void save_motion(const std::string& path, const GeneratedMotion& made);
REMOMASK_API void save_motion(const std::string& path, const EditedMotion& made);
REMOMASK_API void save_motion(const std::string& path, const ScriptedMotion& made);

}  // namespace remomask
