#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "remomask/export.h"

namespace remomask {

/// What a database says about one of its motions. A clip has at most 200 frames: long files
/// are cut into several clips that overlap and share a `source_file`.
struct ClipInfo {
  int64_t id = 0;           ///< assigned by the database
  std::string name;         ///< unique in its database, for example "01_01#2"
  std::string source;       ///< data set, for example "bandai2"
  std::string source_file;  ///< stem of the file that it was cut from
  int start_frame = 0;      ///< first frame of this window in the source, at 20 fps
  std::string split;        ///< "train", "val", "test" or "none"
  std::string licence;
  std::string content_hash;  ///< of the canonical positions; unique in its database
  /// Clips of one group are the same motion: windows of one file, mirror twins, the same take
  /// on another skeleton.
  std::string group;
  bool mirrored = false;  ///< a stored mirror copy (HumanML3D "M...")
  std::string skeleton = "humanml3d";
  int frames = 0;    ///< at the skeleton's frame rate
  double speed = 0;  ///< mean speed of the root over the ground, m/s
  std::vector<std::string> captions;
  std::vector<std::string> tags;  ///< set by the user, in ascending order
};

/// Length of a clip in seconds. Throws Error for a skeleton that is not known.
REMOMASK_API double clip_seconds(const ClipInfo& clip);

}  // namespace remomask
