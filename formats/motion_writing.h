#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "remomask/motion_file.h"

namespace remomask::formats {

/// A motion to be written, and what is known about it.
struct WritingJob {
  const Motion& motion;
  const MotionWriteOptions& options;
  const nlohmann::json* sidecar = nullptr;  ///< a JSON object; null: none
  std::string name = {};                    ///< of the animation in a file that names it
};

/// The bytes of a file, and what save_motion() says about it.
struct WrittenFile {
  std::string bytes;
  WrittenMotion written;
};

/// A format that motions are written in, and the choices that apply to it.
struct MotionFormat {
  std::string_view extension;  ///< in lower case, with its dot
  bool rotations = true;       ///< false: only --fps has a meaning
  bool names = true, units = true;
  bool npz = false, features = false;
  WrittenFile (*write)(const WritingJob& job) = nullptr;
};

const std::vector<MotionFormat>& written_formats();
/// The format of a path's extension. Throws FileError for another one; the message names those
/// that there are.
const MotionFormat& written_format(const std::string& path);
/// ".bvh, .npy or .glb"
std::string written_extensions();
/// Throws Error for a choice that does not apply to the format, and for a frame rate out of range.
void check_write_options(const MotionFormat& format, const MotionWriteOptions& options);

/// Extension of a path in lower case, with its dot; empty if it has none.
std::string lower_extension(const std::string& path);

/// Writes a motion as save_motion() describes, and `sidecar` (a JSON object; null: none) as
/// PATH.json. An old sidecar is removed before the new motion is written, so that no motion ever
/// stands beside the evidence of another one.
WrittenMotion write_motion(const std::string& path, const Motion& motion,
                           const nlohmann::json* sidecar, const MotionWriteOptions& options = {});

}  // namespace remomask::formats
