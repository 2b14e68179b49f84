#include "index/search.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "base/error.h"

namespace remomask {

namespace {

using CollapseKey = std::tuple<std::string, std::string, int>;

CollapseKey collapse_key(const Clip& clip, Collapse collapse) {
  // A mirror copy shares group, source and window with its original; other
  // windows and the trial in another skeleton do not.
  if (collapse == Collapse::mirrors) return {clip.group, clip.source, clip.start_frame};
  return {clip.group, "", 0};
}

/// Clips that were read for this search: queries often find the same ones.
class ClipReader {
 public:
  ClipReader(const Database& database, const VectorIndex& index) : database_(database) {
    if (database.generation() != index.stamp().generation) {
      present_ = database.embedded_clips(index.stamp().retriever_hash);
    }
  }
  /// Whether the database still has what the index has.
  bool has(int64_t id) const {
    return !present_ || std::binary_search(present_->begin(), present_->end(), id);
  }
  const Clip& clip(int64_t id) {
    const auto known = clips_.find(id);
    return known != clips_.end() ? known->second
                                 : clips_.emplace(id, database_.clip(id)).first->second;
  }

 private:
  const Database& database_;
  std::optional<std::vector<int64_t>> present_;  ///< nothing: as in the index
  std::map<int64_t, Clip> clips_;
};

std::vector<SearchHit> collapse_hits(const std::vector<VectorHit>& found, ClipReader& clips,
                                     const SearchOptions& options) {
  std::vector<SearchHit> hits;
  std::set<CollapseKey> seen;
  for (const VectorHit& candidate : found) {
    if (static_cast<int>(hits.size()) == options.k) break;
    if (!clips.has(candidate.clip_id)) continue;
    const Clip& clip = clips.clip(candidate.clip_id);
    if (options.collapse != Collapse::none &&
        !seen.insert(collapse_key(clip, options.collapse)).second) {
      continue;
    }
    hits.push_back({clip, candidate.similarity, static_cast<int>(hits.size()) + 1});
  }
  return hits;
}

}  // namespace

std::vector<std::vector<SearchHit>> search_database(const Database& database,
                                                    const VectorIndex& index, const float* queries,
                                                    int64_t query_count,
                                                    const SearchOptions& options) {
  const ReadSnapshot snapshot(database);
  if (index.stamp().database_uuid != database.uuid()) {
    throw Error(database.path() +
                ": the index belongs to another database; run: remomask index DB");
  }
  std::optional<std::vector<int64_t>> allowed;
  if (!options.filter.empty()) allowed = matching_clips(database, options.filter);
  const std::vector<int64_t>* limit = allowed ? &*allowed : nullptr;

  ClipReader clips(database, index);
  std::vector<std::vector<SearchHit>> results;
  const auto first = index.search(queries, query_count, options.k, limit);
  for (int64_t query = 0; query < query_count; ++query) {
    int64_t wanted = options.k;
    auto found = first[static_cast<size_t>(query)];
    auto hits = collapse_hits(found, clips, options);
    // Collapsing and lost clips leave gaps: look further, until there are enough or no more.
    while (static_cast<int>(hits.size()) < options.k &&
           static_cast<int64_t>(found.size()) == wanted && wanted < index.count()) {
      wanted = std::min(4 * wanted, index.count());
      found = index.search(queries + query * index.width(), 1, wanted, limit).front();
      hits = collapse_hits(found, clips, options);
    }
    results.push_back(std::move(hits));
  }
  return results;
}

}  // namespace remomask
