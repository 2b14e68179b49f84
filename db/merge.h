#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "db/database.h"
#include "remomask/progress.h"

namespace remomask::db {

struct MergeReport {
  int64_t clips = 0;       ///< of the other database
  int64_t added = 0;       ///< of them stored now
  int64_t embeddings = 0;  ///< vectors that came along, of all retrievers
  /// Refused clips and the stored clip of the same motion: {"a", "b"}.
  std::vector<std::pair<std::string, std::string>> duplicates;
  /// Clips whose name was taken: {"a", "a#db2"}.
  std::vector<std::pair<std::string, std::string>> renamed;
  std::vector<std::string> warnings;  ///< captions that a refused clip alone had ...
};

/// Stores the clips of `other` in `target`, with captions, labels, tags,
/// licences, splits, vectors, notes of imports and attributions; all of them or, when stopped
/// or on an error, none. A clip whose motion is there already is refused and
/// reported. Groups of the same name stay apart (the new one gets another name)
/// unless their labels `trial` or `duplicate_of` gave the name; groups that
/// share a motion become one. Throws Error when both are the same file.
MergeReport merge_database(Database& target, const Database& other, const Monitor& monitor = {});

}  // namespace remomask::db
