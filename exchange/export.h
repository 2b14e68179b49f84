#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "db/database.h"
#include "remomask/motion_file.h"
#include "remomask/progress.h"

namespace remomask::exchange {

struct ExportOptions {
  std::string extension = ".npy";  ///< of the files: a format that save_motion() writes
  MotionWriteOptions writing;
  /// Resumes an export of the same clips into the same folder that was stopped or killed.
  bool resume = false;
};

/// Writes these clips as motion files with a captions.jsonl that import_folder()
/// reads back: name, captions, labels, split, licence, group and tags return; the
/// very positions do from npy, those of other formats as they are on the one rigid
/// skeleton that rotations are written on. `folder` is made, or must be empty, or hold an
/// unfinished export to resume. Throws Error otherwise, for a clip that is not there, and
/// Interrupted when stopped. captions.jsonl comes last: a folder without it is not complete, and
/// holds export.json, which says what is being exported.
void export_clips(const db::Database& database, const std::vector<int64_t>& ids,
                  const std::string& folder, const ExportOptions& options,
                  const Monitor& monitor = {});

/// Writes these clips as the animations of one .glb or .fbx file, named as the clips are. In a .glb
/// every animation holds captions, licence and source of its clip. Throws Error for another kind of
/// file, for no clip, for more than a viewer would list, and for a character; Interrupted when
/// stopped, without a file.
void export_together(const db::Database& database, const std::vector<int64_t>& ids,
                     const std::string& path, const MotionWriteOptions& writing,
                     const Monitor& monitor = {});

}  // namespace remomask::exchange
