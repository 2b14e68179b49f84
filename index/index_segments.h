#pragma once

#include <faiss/IndexFlat.h>
#include <faiss/IndexIDMap.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "index/index_changes.h"
#include "index/vector_index.h"

namespace remomask::index {

/// What a VectorIndex searches: the base without its dropped rows, and the added vectors. The
/// latter are always scanned exactly, so every type of base can follow a database, even those that
/// cannot remove vectors (HNSW).
class IndexSegments {
 public:
  /// The rows of `base` are in ascending order of id. `exact` has the same rows; it is null if the
  /// base is a Flat itself.
  IndexSegments(std::unique_ptr<faiss::IndexIDMap2> base, std::unique_ptr<faiss::IndexFlat> exact);

  /// `ids`: everything that is present after these changes, ascending.
  void set_changes(IndexChanges changes, std::vector<int64_t> ids);

  bool is_exact() const { return exact_ == nullptr; }
  int width() const { return base_->d; }
  faiss::IndexIDMap2& base() { return *base_; }
  const faiss::IndexIDMap2& base() const { return *base_; }
  const faiss::IndexFlat* exact() const { return exact_.get(); }
  const std::vector<int64_t>& base_ids() const { return base_->id_map; }
  const IndexChanges& changes() const { return changes_; }
  const std::vector<int64_t>& ids() const { return ids_; }
  /// [wanted][width]; `wanted` (ascending) are present.
  std::vector<float> vectors_of(const std::vector<int64_t>& wanted) const;

  /// As VectorIndex::search.
  std::vector<std::vector<VectorHit>> search_exactly(const float* queries, int64_t query_count,
                                                     int64_t k,
                                                     const std::vector<int64_t>* allowed) const;
  /// Searches the base by its own type and everything else exactly.
  std::vector<std::vector<VectorHit>> search_approximately(const float* queries,
                                                           int64_t query_count, int64_t k) const;

 private:
  const float* base_vectors() const;
  std::vector<std::vector<VectorHit>> scan_base(const float* queries, int64_t query_count,
                                                int64_t k, const std::vector<int64_t>* rows) const;
  std::vector<std::vector<VectorHit>> scan_added(const float* queries, int64_t query_count,
                                                 int64_t k, const std::vector<int64_t>* rows) const;
  std::vector<std::vector<int64_t>> find_rows(const float* queries, int64_t query_count,
                                              int64_t fetched) const;

  std::unique_ptr<faiss::IndexIDMap2> base_;
  std::unique_ptr<faiss::IndexFlat> exact_;
  IndexChanges changes_;
  std::vector<uint8_t> dropped_rows_;  ///< [rows of the base], 1: dropped; empty: none
  std::vector<int64_t> ids_;
};

}  // namespace remomask::index
