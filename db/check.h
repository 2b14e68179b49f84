#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "remomask/progress.h"

namespace remomask::db {

struct Defect {
  int64_t clip_id = 0;  ///< 0: of the database as a whole
  std::string clip;     ///< name of the clip; empty when it has none
  std::string what;     ///< and what to do about it
};

struct CheckReport {
  int64_t clips = 0, captions = 0, embeddings = 0;  ///< looked at
  std::vector<Defect> defects;                      ///< first of the whole, then by clip
  bool has_checksums = true;  ///< false: a format before 6, in which damage can hide
};

/// Looks at everything that is stored: the file's pages (SQLite's own check),
/// references between tables, facts; of every clip the number of frames, the
/// size of its positions, values that are no numbers, its content hash, speed,
/// captions and labels; that the full-text index answers for exactly the stored
/// captions; widths and lengths of the vectors. Writes nothing. Throws Error
/// when the file cannot be opened as a database of the present format;
/// Interrupted when stopped.
CheckReport check_database(const std::string& path, const Monitor& monitor = {});

}  // namespace remomask::db
