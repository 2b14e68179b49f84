#include "index/update_index.h"

#include <filesystem>
#include <utility>

#include "index/faiss_index.h"
#include "index/index_changes.h"
#include "index/index_file.h"
#include "remomask/error.h"

namespace remomask::index {

namespace {

/// The pair of files without the vectors of the base.
struct IndexPair {
  IndexHeader base;
  IndexDelta delta;
};

/// The pair, or why it cannot be continued. A damaged delta costs nothing: the base without it is
/// an older state.
std::pair<std::optional<IndexPair>, std::string> read_pair(const std::string& path,
                                                           const db::Database& database,
                                                           const std::string& retriever_hash) {
  if (!std::filesystem::exists(path)) return {std::nullopt, "there was none"};
  try {
    IndexPair pair{read_index_header(path), {}};
    pair.delta.stamp = pair.base.stamp;
    require_same_origin(path, pair.base.stamp, database, retriever_hash);
    try {
      if (auto delta = read_index_delta(path, pair.base)) {
        require_same_origin(path, delta->stamp, database, retriever_hash);
        pair.delta = std::move(*delta);
      }
    } catch (const FileError&) {
      pair.delta.stamp.generation = -1;  // not even an unchanged database leaves it as it is
    }
    return {std::move(pair), ""};
  } catch (const Error& error) {
    return {std::nullopt, error.what()};
  }
}

bool same_type(const IndexType& type, const VectorIndexOptions& options) {
  return type.requested == options.factory &&
         (options.search_parameters.empty() || type.search_parameters == options.search_parameters);
}

}  // namespace

IndexUpdate update_index(const std::string& path, const db::Database& database,
                         const std::string& retriever_hash, const UpdateOptions& options,
                         const Monitor& monitor) {
  // Read before the snapshot: what is written must not be older than what was there.
  auto [pair, reason] = read_pair(path, database, retriever_hash);
  const db::ReadSnapshot snapshot(database);
  VectorIndexOptions type = options.type.value_or(VectorIndexOptions{});
  IndexDifference difference;
  if (pair) {
    auto& [base, delta] = *pair;
    if (!options.type) {
      type.factory = base.type.requested;
      if (type.factory != "auto") type.search_parameters = base.type.search_parameters;
    }
    const FollowedState state =
        follow_database(database, base.ids, base.width, delta.stamp, delta.changes);
    const auto count = static_cast<int64_t>(state.ids.size());
    difference = state.difference;
    if (options.rebuild) {
      reason = "asked for";
    } else if (!same_type(base.type, type)) {
      reason = "another type is wanted";
    } else if (resolve_factory(base.type.requested, count) != base.type.factory) {
      reason = "the type depends on the number of clips";
    } else if (worth_folding(base, delta.changes)) {
      reason = "many clips have changed";
    } else {
      write_index_delta(path, base, delta);
      return {base.type, count, base.width, difference, ""};
    }
  }
  VectorIndex index = VectorIndex::build(database, retriever_hash, type, monitor);
  index.save(path);
  if (!pair) difference.added = index.count();
  return {index.type(), index.count(), index.width(), difference, reason};
}

}  // namespace remomask::index
