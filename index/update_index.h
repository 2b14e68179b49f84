#pragma once

#include <optional>
#include <string>

#include "index/vector_index.h"

namespace remomask::index {

struct UpdateOptions {
  /// Nothing: the type that the file has, "auto" for a new one.
  std::optional<VectorIndexOptions> type;
  bool rebuild = false;
};

/// What update_index() did.
struct IndexUpdate {
  IndexType type;
  int64_t count = 0;
  int width = 0;
  IndexDifference difference;  ///< against what the file held; a new one has added all
  std::string rebuilt;         ///< why the base was built anew; empty when it was not
};

/// Brings the index file `path` to the database's present state. Costs no more
/// than the changes: the vectors of the base are not even read, unless it has
/// to be built anew, because it is missing, damaged, of another database,
/// retriever or type, or because the changes have become too many. Throws as
/// VectorIndex::build().
IndexUpdate update_index(const std::string& path, const db::Database& database,
                         const std::string& retriever_hash, const UpdateOptions& options = {},
                         const Monitor& monitor = {});

}  // namespace remomask::index
