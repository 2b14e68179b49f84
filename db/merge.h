#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "db/database.h"
#include "remomask/progress.h"

namespace remomask::db {

struct MergeReport {
  int64_t clips = 0;       ///< in the other database
  int64_t added = 0;       ///< clips that were stored
  int64_t embeddings = 0;  ///< vectors that were copied, of all retrievers
  /// Refused clips, each with the stored clip of the same motion: {"a", "b"}.
  std::vector<std::pair<std::string, std::string>> duplicates;
  /// Clips whose name was taken, with the new name: {"a", "a#db2"}.
  std::vector<std::pair<std::string, std::string>> renamed;
  std::vector<std::string> warnings;  ///< for example captions that only a refused clip had
};

/// Stores the clips of `other` in `target`, with captions, labels, tags,
/// licences, splits, vectors, import notes and attributions: all of them or, if stopped
/// or on an error, none. A clip whose motion is already stored is refused and
/// reported. Groups of the same name stay apart (the new one is renamed)
/// unless the name came from their labels `trial` or `duplicate_of`; groups that
/// share a motion are joined. Throws Error if both databases are the same file.
MergeReport merge_database(Database& target, const Database& other, const Monitor& monitor = {});

}  // namespace remomask::db
