#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "remomask/progress.h"

namespace remomask::db {

struct Defect {
  int64_t clip_id = 0;  ///< 0: the database as a whole
  std::string clip;     ///< name of the clip; empty if it has none
  std::string what;     ///< what is wrong, and what to do about it
};

struct CheckReport {
  int64_t clips = 0, captions = 0, embeddings = 0;  ///< that were checked
  std::vector<Defect> defects;                      ///< those of the database first, then by clip
  bool has_checksums = true;  ///< false: a format before 7, in which damage can hide
};

/// Checks everything that is stored: the pages of the file (SQLite's own check), references
/// between tables, and facts; for every clip the number of frames, the size of its positions,
/// values that are not finite, its content hash, speed, captions and labels; that the full-text
/// index holds exactly the stored captions; and the widths and lengths of the vectors. Writes
/// nothing. Throws Error if the file cannot be opened as a database of the current format, and
/// Interrupted if stopped.
CheckReport check_database(const std::string& path, const Monitor& monitor = {});

}  // namespace remomask::db
