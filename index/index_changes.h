#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "db/database.h"
#include "index/index_file.h"
#include "index/vector_index.h"

namespace remomask::index {

/// What the present state has and lacks compared with the base, the index as it was built. The
/// vector of a clip id never changes for one retriever, so the ids describe every change.
struct IndexChanges {
  std::vector<int64_t> dropped;  ///< of the base, ascending
  std::vector<int64_t> added;    ///< not in the base, ascending
  std::vector<float> vectors;    ///< [added][width]

  bool empty() const { return dropped.empty() && added.empty(); }
};

/// Motion vectors of database rows, one after the other. Throws Error if one has another width or
/// is not L2-normalised.
std::vector<float> motion_vectors(const db::Database& database,
                                  const std::vector<db::ClipEmbedding>& embeddings, int width);

IndexStamp present_stamp(const db::Database& database, const std::string& retriever_hash);

/// Throws Error if the index at `path` with this stamp belongs to another database or retriever, to
/// a state that this database has not reached, or to a copy of it that was changed separately.
void require_same_origin(const std::string& path, const IndexStamp& stamp,
                         const db::Database& database, const std::string& retriever_hash);

/// Brings `changes` and `stamp` to the database's present state, which the caller holds by a
/// ReadSnapshot. Reads only what has changed if the database still logs that
/// (Database::embedding_changes), otherwise a list of all ids. Returns the ids that are present
/// now, ascending, and what was new among them.
struct FollowedState {
  std::vector<int64_t> ids;
  IndexDifference difference;
};
FollowedState follow_database(const db::Database& database, const std::vector<int64_t>& base_ids,
                              int width, IndexStamp& stamp, IndexChanges& changes);

/// Whether there are enough changes to build a new base: more than 10 % of its clips, or 2 % for
/// approximate types, whose added clips are scanned exactly.
bool worth_folding(const IndexHeader& base, const IndexChanges& changes);

/// The changes as a file beside the base.
struct IndexDelta {
  IndexStamp stamp;
  IndexChanges changes;
};

/// The delta of the index file `path`.
std::string delta_path(const std::string& path);

/// Writes the delta of the index file `path` atomically, or removes it if the base alone already
/// says the same.
void write_index_delta(const std::string& path, const IndexHeader& base, const IndexDelta& delta);

/// Reads the delta. Returns nothing if there is none or if it belongs to another base, as after a
/// kill between writing a new base and removing its old delta. Throws FileError if it is truncated
/// or damaged.
std::optional<IndexDelta> read_index_delta(const std::string& path, const IndexHeader& base);

}  // namespace remomask::index
