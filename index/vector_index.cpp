#include "index/vector_index.h"

#include <faiss/AutoTune.h>
#include <faiss/IndexFlat.h>
#include <faiss/IndexIDMap.h>
#include <faiss/IndexIVF.h>
#include <faiss/impl/FaissException.h>
#include <faiss/index_factory.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "index/exact_scan.h"
#include "index/index_file.h"

namespace remomask {

namespace {

constexpr double kNormTolerance = 1e-3;
constexpr int64_t kRowsPerAddition = 8192;

void check_normalised(const float* vector, int width, const std::string& subject) {
  double square = 0;
  for (int i = 0; i < width; ++i) square += static_cast<double>(vector[i]) * vector[i];
  if (!(std::abs(std::sqrt(square) - 1) <= kNormTolerance)) {
    throw Error(fmt::format("{} has length {:.4g} instead of 1; normalise it (L2)", subject,
                            std::sqrt(square)));
  }
}

std::unique_ptr<faiss::Index> make_faiss_index(int width, const VectorIndexOptions& options) {
  std::unique_ptr<faiss::Index> index(
      faiss::index_factory(width, options.factory.c_str(), faiss::METRIC_INNER_PRODUCT));
  if (dynamic_cast<faiss::IndexIDMap*>(index.get())) {
    throw Error("the index type '" + options.factory + "' maps ids itself; leave IDMap away");
  }
  if (auto* lists = dynamic_cast<faiss::IndexIVF*>(index.get())) {
    // FAISS writes a warning to stderr below this number; libraries never print.
    lists->cp.min_points_per_centroid = 1;
  }
  return index;
}

}  // namespace

struct VectorIndex::Impl {
  IndexStamp stamp;
  std::string factory;
  std::unique_ptr<faiss::IndexIDMap2> index;
  std::unique_ptr<faiss::IndexFlat> exact;  ///< null for "Flat", which is exact itself

  const faiss::IndexFlat& flat() const {
    return exact ? *exact : dynamic_cast<const faiss::IndexFlat&>(*index->index);
  }
  const float* vectors() const { return flat().get_xb(); }
  const std::vector<int64_t>& ids() const { return index->id_map; }

  /// Row of a clip; -1 when the index has none.
  int64_t row_of(int64_t id) const {
    const auto found = std::lower_bound(ids().begin(), ids().end(), id);
    return found != ids().end() && *found == id ? found - ids().begin() : -1;
  }

  void fill(const std::vector<int64_t>& sorted_ids, const std::vector<float>& sorted, int width,
            const VectorIndexOptions& options, const Monitor& monitor) {
    const auto count = static_cast<int64_t>(sorted_ids.size());
    auto inner = make_faiss_index(width, options);
    if (!inner->is_trained) inner->train(count, sorted.data());
    index = std::make_unique<faiss::IndexIDMap2>(inner.get());
    inner.release();
    index->own_fields = true;
    for (int64_t first = 0; first < count; first += kRowsPerAddition) {
      if (monitor.stop_requested()) {
        throw Interrupted("building the index was stopped; nothing was written");
      }
      const int64_t rows = std::min(kRowsPerAddition, count - first);
      index->add_with_ids(rows, sorted.data() + first * width, sorted_ids.data() + first);
      monitor.report({"index", static_cast<double>(first + rows), static_cast<double>(count), ""});
    }
    if (!options.search_parameters.empty()) {
      faiss::ParameterSpace().set_index_parameters(index.get(), options.search_parameters.c_str());
    }
    if (!dynamic_cast<faiss::IndexFlat*>(index->index)) {
      exact = std::make_unique<faiss::IndexFlat>(width, faiss::METRIC_INNER_PRODUCT);
      exact->add(count, sorted.data());
    }
  }

  std::vector<std::vector<VectorHit>> search_exactly(const float* queries, int64_t query_count,
                                                     int64_t k,
                                                     const std::vector<int64_t>* rows) const {
    std::vector<std::vector<VectorHit>> hits;
    for (const auto& found :
         exact_top_k(vectors(), index->ntotal, index->d, rows, queries, query_count, k)) {
      auto& list = hits.emplace_back();
      for (const RowScore& row : found) {
        list.push_back({ids()[static_cast<size_t>(row.row)], row.score});
      }
    }
    return hits;
  }

  std::vector<std::vector<VectorHit>> search_approximately(const float* queries,
                                                           int64_t query_count, int64_t k) const {
    std::vector<float> scores(static_cast<size_t>(query_count * k));
    std::vector<int64_t> found(scores.size());
    index->search(query_count, queries, k, scores.data(), found.data());
    std::vector<std::vector<VectorHit>> hits;
    for (int64_t query = 0; query < query_count; ++query) {
      std::vector<int64_t> rows;
      for (int64_t i = 0; i < k; ++i) {
        const int64_t id = found[static_cast<size_t>(query * k + i)];
        if (id >= 0) rows.push_back(row_of(id));  // -1 fills up what was not found
      }
      std::sort(rows.begin(), rows.end());
      hits.push_back(search_exactly(queries + query * index->d, 1, k, &rows).front());
    }
    return hits;
  }
};

VectorIndex::VectorIndex(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
VectorIndex::~VectorIndex() = default;
VectorIndex::VectorIndex(VectorIndex&&) noexcept = default;
VectorIndex& VectorIndex::operator=(VectorIndex&&) noexcept = default;

VectorIndex::VectorIndex(IndexStamp stamp, const std::vector<int64_t>& ids,
                         const std::vector<float>& vectors, int width,
                         const VectorIndexOptions& options, const Monitor& monitor)
    : impl_(std::make_unique<Impl>()) {
  if (ids.empty() || width < 1 || vectors.size() != ids.size() * static_cast<size_t>(width)) {
    throw Error(fmt::format("an index needs vectors of one width: {} clips, width {}, {} numbers",
                            ids.size(), width, vectors.size()));
  }
  std::vector<size_t> order(ids.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return ids[a] < ids[b]; });
  std::vector<int64_t> sorted_ids;
  std::vector<float> sorted;
  sorted.reserve(vectors.size());
  for (const size_t i : order) {
    if (!sorted_ids.empty() && sorted_ids.back() == ids[i]) {
      throw Error(fmt::format("clip number {} has two vectors; embed the clips again", ids[i]));
    }
    const float* vector = vectors.data() + i * static_cast<size_t>(width);
    check_normalised(vector, width, fmt::format("the vector of clip number {}", ids[i]));
    sorted_ids.push_back(ids[i]);
    sorted.insert(sorted.end(), vector, vector + width);
  }
  impl_->stamp = std::move(stamp);
  impl_->factory = options.factory;
  try {
    impl_->fill(sorted_ids, sorted, width, options, monitor);
  } catch (const faiss::FaissException& error) {
    throw Error(fmt::format(
        "FAISS cannot build an index of type '{}' with parameters '{}' over {} vectors ({}); "
        "use another type, or Flat",
        options.factory, options.search_parameters, ids.size(), error.what()));
  }
}

VectorIndex VectorIndex::build(const Database& database, const std::string& retriever_hash,
                               const VectorIndexOptions& options, const Monitor& monitor) {
  // Read before the vectors: a change in between makes the index stale, not wrong.
  IndexStamp stamp{database.uuid(), database.generation(), retriever_hash};
  const std::vector<ClipEmbedding> embeddings = database.embeddings(retriever_hash);
  if (embeddings.empty()) {
    throw Error(database.path() + ": has no vectors of this retriever (" + retriever_hash +
                "); run: remomask index DB");
  }
  const size_t width = embeddings.front().motion.size();
  std::vector<int64_t> ids;
  std::vector<float> vectors;
  vectors.reserve(embeddings.size() * width);
  for (const ClipEmbedding& embedding : embeddings) {
    if (embedding.motion.size() != width || width == 0) {
      throw Error(
          fmt::format("{}: the vector of clip number {} has {} numbers instead of {}; "
                      "run: remomask index DB",
                      database.path(), embedding.clip_id, embedding.motion.size(), width));
    }
    ids.push_back(embedding.clip_id);
    vectors.insert(vectors.end(), embedding.motion.begin(), embedding.motion.end());
  }
  return VectorIndex(std::move(stamp), ids, vectors, static_cast<int>(width), options, monitor);
}

void VectorIndex::save(const std::string& path) const {
  write_index_file(path, impl_->stamp, impl_->factory, *impl_->index, impl_->exact.get());
}

VectorIndex VectorIndex::load(const std::string& path, const Database& database,
                              const std::string& retriever_hash) {
  IndexFile file = read_index_file(path);
  auto impl = std::make_unique<Impl>();
  impl->stamp = std::move(file.stamp);
  impl->factory = std::move(file.factory);
  impl->index = std::move(file.index);
  impl->exact = std::move(file.exact);
  VectorIndex index(std::move(impl));
  if (index.stamp().retriever_hash != retriever_hash) {
    throw Error(path + ": this index was built with another retriever (" +
                index.stamp().retriever_hash + " instead of " + retriever_hash +
                "); run: remomask index DB");
  }
  index.require_current(database);
  return index;
}

void VectorIndex::require_current(const Database& database) const {
  if (stamp().database_uuid != database.uuid() || stamp().generation != database.generation()) {
    throw Error(database.path() +
                ": the database has changed since this index was built; run: remomask index DB");
  }
}

std::vector<std::vector<VectorHit>> VectorIndex::search(const float* queries, int64_t query_count,
                                                        int64_t k,
                                                        const std::vector<int64_t>* allowed) const {
  if (k < 1) throw Error("a search returns at least one clip; ask for k of 1 or more");
  for (int64_t i = 0; i < query_count; ++i) {
    check_normalised(queries + i * width(), width(), fmt::format("query {}", i));
  }
  k = std::min(k, count());
  if (allowed) {
    std::vector<int64_t> rows;
    for (const int64_t id : *allowed) {
      if (const int64_t row = impl_->row_of(id); row >= 0) rows.push_back(row);
    }
    return impl_->search_exactly(queries, query_count, k, &rows);
  }
  if (!impl_->exact) return impl_->search_exactly(queries, query_count, k, nullptr);
  return impl_->search_approximately(queries, query_count, k);
}

int64_t VectorIndex::count() const { return impl_->index->ntotal; }
int VectorIndex::width() const { return impl_->index->d; }
const std::string& VectorIndex::factory() const { return impl_->factory; }
const IndexStamp& VectorIndex::stamp() const { return impl_->stamp; }
const std::vector<int64_t>& VectorIndex::clip_ids() const { return impl_->ids(); }

std::string default_index_path(const std::string& database_path) {
  return database_path + ".index";
}

}  // namespace remomask
