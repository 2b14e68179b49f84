#include "index/index_segments.h"

#include <algorithm>
#include <iterator>

#include "index/exact_scan.h"

namespace remomask::index {

namespace {

using HitLists = std::vector<std::vector<VectorHit>>;

/// Places in `ids` of those that `allowed` has too; both ascending.
std::vector<int64_t> rows_of(const std::vector<int64_t>& ids, const std::vector<int64_t>& allowed) {
  std::vector<int64_t> rows;
  auto place = ids.begin();
  for (const int64_t id : allowed) {
    place = std::lower_bound(place, ids.end(), id);
    if (place == ids.end()) break;
    if (*place == id) rows.push_back(place - ids.begin());
  }
  return rows;
}

std::vector<VectorHit> hits_of(const std::vector<RowScore>& found,
                               const std::vector<int64_t>& ids) {
  std::vector<VectorHit> hits;
  for (const RowScore& row : found) hits.push_back({ids[static_cast<size_t>(row.row)], row.score});
  return hits;
}

bool better_hit(const VectorHit& left, const VectorHit& right) {
  return left.similarity != right.similarity ? left.similarity > right.similarity
                                             : left.clip_id < right.clip_id;
}

HitLists merge_hits(const HitLists& left, const HitLists& right, int64_t k) {
  HitLists merged;
  for (size_t query = 0; query < left.size(); ++query) {
    auto& hits = merged.emplace_back();
    std::merge(left[query].begin(), left[query].end(), right[query].begin(), right[query].end(),
               std::back_inserter(hits), better_hit);
    hits.resize(std::min(hits.size(), static_cast<size_t>(k)));
  }
  return merged;
}

}  // namespace

IndexSegments::IndexSegments(std::unique_ptr<faiss::IndexIDMap2> base,
                             std::unique_ptr<faiss::IndexFlat> exact)
    : base_(std::move(base)), exact_(std::move(exact)), ids_(base_->id_map) {}

void IndexSegments::set_changes(IndexChanges changes, std::vector<int64_t> ids) {
  changes_ = std::move(changes);
  ids_ = std::move(ids);
  dropped_rows_.clear();
  if (changes_.dropped.empty()) return;
  dropped_rows_.assign(base_ids().size(), 0);
  for (const int64_t row : rows_of(base_ids(), changes_.dropped)) {
    dropped_rows_[static_cast<size_t>(row)] = 1;
  }
}

const float* IndexSegments::base_vectors() const {
  return (exact_ ? *exact_ : dynamic_cast<const faiss::IndexFlat&>(*base_->index)).get_xb();
}

std::vector<float> IndexSegments::vectors_of(const std::vector<int64_t>& wanted) const {
  std::vector<float> result;
  result.reserve(wanted.size() * static_cast<size_t>(width()));
  for (const int64_t id : wanted) {
    const auto added = std::lower_bound(changes_.added.begin(), changes_.added.end(), id);
    const bool is_added = added != changes_.added.end() && *added == id;
    const auto row =
        is_added ? added - changes_.added.begin()
                 : std::lower_bound(base_ids().begin(), base_ids().end(), id) - base_ids().begin();
    const float* vector = (is_added ? changes_.vectors.data() : base_vectors()) + row * width();
    result.insert(result.end(), vector, vector + width());
  }
  return result;
}

HitLists IndexSegments::scan_base(const float* queries, int64_t query_count, int64_t k,
                                  const std::vector<int64_t>* rows) const {
  const RowChoice choice{rows, dropped_rows_.empty() ? nullptr : &dropped_rows_};
  HitLists hits;
  for (const auto& found :
       exact_top_k(base_vectors(), base_->ntotal, width(), choice, queries, query_count, k)) {
    hits.push_back(hits_of(found, base_ids()));
  }
  return hits;
}

HitLists IndexSegments::scan_added(const float* queries, int64_t query_count, int64_t k,
                                   const std::vector<int64_t>* rows) const {
  HitLists hits;
  for (const auto& found :
       exact_top_k(changes_.vectors.data(), static_cast<int64_t>(changes_.added.size()), width(),
                   {rows, nullptr}, queries, query_count, k)) {
    hits.push_back(hits_of(found, changes_.added));
  }
  return hits;
}

HitLists IndexSegments::search_exactly(const float* queries, int64_t query_count, int64_t k,
                                       const std::vector<int64_t>* allowed) const {
  if (!allowed) {
    return merge_hits(scan_base(queries, query_count, k, nullptr),
                      scan_added(queries, query_count, k, nullptr), k);
  }
  const auto base_rows = rows_of(base_ids(), *allowed);
  const auto added_rows = rows_of(changes_.added, *allowed);
  return merge_hits(scan_base(queries, query_count, k, &base_rows),
                    scan_added(queries, query_count, k, &added_rows), k);
}

/// The rows of the base that its type finds, without the dropped ones, ascending.
std::vector<std::vector<int64_t>> IndexSegments::find_rows(const float* queries,
                                                           int64_t query_count,
                                                           int64_t fetched) const {
  std::vector<float> scores(static_cast<size_t>(query_count * fetched));
  std::vector<int64_t> found(scores.size());
  // The inner index answers with rows instead of ids.
  base_->index->search(query_count, queries, fetched, scores.data(), found.data());
  std::vector<std::vector<int64_t>> rows(static_cast<size_t>(query_count));
  for (size_t i = 0; i < found.size(); ++i) {
    const int64_t row = found[i];  // -1 fills up what was not found
    if (row < 0 || (!dropped_rows_.empty() && dropped_rows_[static_cast<size_t>(row)])) continue;
    rows[i / static_cast<size_t>(fetched)].push_back(row);
  }
  for (auto& list : rows) std::sort(list.begin(), list.end());
  return rows;
}

HitLists IndexSegments::search_approximately(const float* queries, int64_t query_count,
                                             int64_t k) const {
  const auto live = base_->ntotal - static_cast<int64_t>(changes_.dropped.size());
  const auto wanted = static_cast<size_t>(std::min(k, live));
  // Asks for some more, since dropped rows are found as well.
  int64_t fetched = std::min(base_->ntotal, changes_.dropped.empty() ? k : 2 * k);
  auto rows = find_rows(queries, query_count, fetched);
  HitLists hits;
  for (int64_t query = 0; query < query_count; ++query) {
    const float* vector = queries + query * width();
    auto& found = rows[static_cast<size_t>(query)];
    for (int64_t more = 4 * fetched; found.size() < wanted && more <= 64 * fetched; more *= 4) {
      found = std::move(find_rows(vector, 1, std::min(more, base_->ntotal)).front());
    }
    // The type finds no more, because of the dropped rows or its own limits.
    const bool enough = found.size() >= wanted;
    hits.push_back(std::move(scan_base(vector, 1, k, enough ? &found : nullptr).front()));
  }
  return merge_hits(hits, scan_added(queries, query_count, k, nullptr), k);
}

}  // namespace remomask::index
