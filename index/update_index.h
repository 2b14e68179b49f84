#pragma once

#include <optional>
#include <string>

#include "index/vector_index.h"

namespace remomask::index {

struct UpdateOptions {
  /// Unset: the type that the file has, "auto" for a new file.
  std::optional<VectorIndexOptions> type;
  bool rebuild = false;
};

/// What update_index() did.
struct IndexUpdate {
  IndexType type;
  int64_t count = 0;
  int width = 0;
  IndexDifference difference;  ///< against what the file held; in a new file everything is added
  std::string rebuilt;         ///< why the base was rebuilt; empty if it was not
};

/// Brings the index file `path` to the database's present state. Costs no more than the changes:
/// the vectors of the base are not even read, unless the base must be rebuilt because it is
/// missing, damaged, of another database, retriever or type, or because there are too many changes.
/// Throws like VectorIndex::build().
IndexUpdate update_index(const std::string& path, const db::Database& database,
                         const std::string& retriever_hash, const UpdateOptions& options = {},
                         const Monitor& monitor = {});

}  // namespace remomask::index
