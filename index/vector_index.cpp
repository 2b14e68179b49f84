#include "index/vector_index.h"

#include <faiss/IndexFlat.h>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "index/exact_scan.h"
#include "index/faiss_index.h"
#include "index/index_changes.h"
#include "index/index_file.h"
#include "index/index_segments.h"
#include "index/recall.h"
#include "remomask/error.h"

namespace remomask::index {

namespace {

/// Vectors by ascending id. Throws Error for an id that comes twice.
void sort_by_id(std::vector<int64_t>& ids, std::vector<float>& vectors, int width) {
  std::vector<size_t> order(ids.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return ids[a] < ids[b]; });
  std::vector<int64_t> sorted_ids;
  std::vector<float> sorted;
  sorted.reserve(vectors.size());
  for (const size_t i : order) {
    sorted_ids.push_back(ids[i]);
    const float* vector = vectors.data() + i * static_cast<size_t>(width);
    sorted.insert(sorted.end(), vector, vector + width);
  }
  ids = std::move(sorted_ids);
  vectors = std::move(sorted);
}

bool holds_base(const std::string& path, const std::string& checksum) {
  try {
    return read_index_header(path).checksum == checksum;
  } catch (const FileError&) {  // removed or damaged in the meantime: rewritten
    return false;
  }
}

}  // namespace

struct VectorIndex::Impl {
  /// Of the base: stamp.generation is that of its building.
  IndexHeader base;
  std::string base_path;  ///< empty: the base is in no file
  IndexStamp stamp;       ///< of the present state
  IndexSegments segments;

  /// `ids` ascending, all vectors checked.
  static std::unique_ptr<Impl> build(IndexStamp stamp, const std::vector<int64_t>& ids,
                                     const float* vectors, int width,
                                     const VectorIndexOptions& options, const Monitor& monitor) {
    IndexType type{options.factory,
                   resolve_factory(options.factory, static_cast<int64_t>(ids.size())),
                   options.search_parameters, std::nullopt};
    auto faiss_index = build_faiss_index(ids, vectors, width, type, monitor);
    std::unique_ptr<faiss::IndexFlat> exact;
    if (!dynamic_cast<faiss::IndexFlat*>(faiss_index->index)) {
      exact = std::make_unique<faiss::IndexFlat>(width, faiss::METRIC_INNER_PRODUCT);
      exact->add(static_cast<int64_t>(ids.size()), vectors);
    }
    IndexSegments segments(std::move(faiss_index), std::move(exact));
    if (!segments.is_exact()) {
      const RecallSample sample(segments);
      if (type.requested == "auto" && type.search_parameters.empty()) {
        type.search_parameters = tune_probes(segments, sample);
      }
      type.recall = sample.measure(segments);
    }
    return std::unique_ptr<Impl>(new Impl{
        .base =
            {.stamp = stamp, .type = std::move(type), .width = width, .ids = ids, .checksum = ""},
        .base_path = "",
        .stamp = stamp,
        .segments = std::move(segments)});
  }
};

VectorIndex::VectorIndex(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
VectorIndex::~VectorIndex() = default;
VectorIndex::VectorIndex(VectorIndex&&) noexcept = default;
VectorIndex& VectorIndex::operator=(VectorIndex&&) noexcept = default;

VectorIndex::VectorIndex(IndexStamp stamp, const std::vector<int64_t>& ids,
                         const std::vector<float>& vectors, int width,
                         const VectorIndexOptions& options, const Monitor& monitor) {
  if (ids.empty() || width < 1 || vectors.size() != ids.size() * static_cast<size_t>(width)) {
    throw Error(fmt::format("an index needs vectors of one width: {} clips, width {}, {} numbers",
                            ids.size(), width, vectors.size()));
  }
  for (size_t i = 0; i < ids.size(); ++i) {
    require_unit_length(vectors.data() + i * static_cast<size_t>(width), width,
                        fmt::format("the vector of clip number {}", ids[i]));
  }
  std::vector<int64_t> sorted_ids = ids;
  std::vector<float> sorted;
  const float* source = vectors.data();
  if (!std::is_sorted(ids.begin(), ids.end())) {
    sorted = vectors;
    sort_by_id(sorted_ids, sorted, width);
    source = sorted.data();
  }
  const auto twice = std::adjacent_find(sorted_ids.begin(), sorted_ids.end());
  if (twice != sorted_ids.end()) {
    throw Error(fmt::format("clip number {} has two vectors; embed the clips again", *twice));
  }
  impl_ = Impl::build(std::move(stamp), sorted_ids, source, width, options, monitor);
}

VectorIndex VectorIndex::build(const db::Database& database, const std::string& retriever_hash,
                               const VectorIndexOptions& options, const Monitor& monitor) {
  const db::ReadSnapshot snapshot(database);
  IndexStamp stamp = present_stamp(database, retriever_hash);
  const std::vector<db::ClipEmbedding> embeddings = database.embeddings(retriever_hash);
  if (embeddings.empty()) {
    throw Error(database.path() + ": has no vectors of this retriever (" + retriever_hash +
                "); run: remomask index DB");
  }
  const auto width = static_cast<int>(embeddings.front().motion.size());
  std::vector<int64_t> ids;
  for (const db::ClipEmbedding& embedding : embeddings) ids.push_back(embedding.clip_id);
  const std::vector<float> vectors = motion_vectors(database, embeddings, width);
  return VectorIndex(Impl::build(std::move(stamp), ids, vectors.data(), width, options, monitor));
}

VectorIndex VectorIndex::open(const std::string& path, const db::Database& database,
                              const std::string& retriever_hash) {
  IndexFile file = read_index_file(path);
  IndexDelta delta{file.header.stamp, {}};
  if (auto known = read_index_delta(path, file.header)) delta = std::move(*known);
  IndexSegments segments(std::move(file.index), std::move(file.exact));
  const db::ReadSnapshot snapshot(database);
  require_same_origin(path, delta.stamp, database, retriever_hash);
  const FollowedState state =
      follow_database(database, file.header.ids, file.header.width, delta.stamp, delta.changes);
  segments.set_changes(std::move(delta.changes), state.ids);
  return VectorIndex(std::unique_ptr<Impl>(
      new Impl{std::move(file.header), path, std::move(delta.stamp), std::move(segments)}));
}

IndexDifference VectorIndex::follow(const db::Database& database) {
  const db::ReadSnapshot snapshot(database);
  require_same_origin("the index in memory", stamp(), database, stamp().retriever_hash);
  IndexChanges changes = impl_->segments.changes();
  FollowedState state =
      follow_database(database, impl_->segments.base_ids(), width(), impl_->stamp, changes);
  impl_->segments.set_changes(std::move(changes), std::move(state.ids));
  return state.difference;
}

void VectorIndex::save(const std::string& path) {
  IndexSegments& segments = impl_->segments;
  const bool beside_its_base = impl_->base_path == path && holds_base(path, impl_->base.checksum);
  if (beside_its_base && (count() == 0 || !worth_folding(impl_->base, segments.changes()))) {
    return write_index_delta(path, impl_->base, {stamp(), segments.changes()});
  }
  if (count() == 0)
    throw Error(path + ": an index without clips cannot be written; embed some clips first");
  if (!segments.changes().empty()) {
    const IndexType type = impl_->base.type;
    // A number of probes that "auto" chose is chosen anew.
    const VectorIndexOptions options{type.requested,
                                     type.requested == "auto" ? "" : type.search_parameters};
    impl_ = Impl::build(stamp(), segments.ids(), segments.vectors_of(segments.ids()).data(),
                        width(), options, {});
  }
  impl_->base.stamp = stamp();
  impl_->base.checksum =
      write_index_file(path, stamp(), type(), impl_->segments.base(), impl_->segments.exact());
  impl_->base_path = path;
  write_index_delta(path, impl_->base, {stamp(), {}});  // removes an old one
}

void VectorIndex::require_current(const db::Database& database) const {
  const IndexStamp now = present_stamp(database, stamp().retriever_hash);
  if (stamp().database_uuid != now.database_uuid || stamp().generation != now.generation ||
      stamp().writer != now.writer) {
    throw Error(database.path() +
                ": the database has changed since this index was opened; "
                "start again");
  }
}

std::vector<std::vector<VectorHit>> VectorIndex::search(const float* queries, int64_t query_count,
                                                        int64_t k,
                                                        const std::vector<int64_t>* allowed) const {
  if (k < 1) throw Error("k must be 1 or more");
  for (int64_t i = 0; i < query_count; ++i) {
    require_unit_length(queries + i * width(), width(), fmt::format("query {}", i));
  }
  k = std::min(k, count());
  if (k == 0) return std::vector<std::vector<VectorHit>>(static_cast<size_t>(query_count));
  const IndexSegments& segments = impl_->segments;
  return allowed || segments.is_exact() ? segments.search_exactly(queries, query_count, k, allowed)
                                        : segments.search_approximately(queries, query_count, k);
}

int64_t VectorIndex::count() const { return static_cast<int64_t>(clip_ids().size()); }
int VectorIndex::width() const { return impl_->segments.width(); }
const IndexType& VectorIndex::type() const { return impl_->base.type; }
const IndexStamp& VectorIndex::stamp() const { return impl_->stamp; }
const std::vector<int64_t>& VectorIndex::clip_ids() const { return impl_->segments.ids(); }

std::string default_index_path(const std::string& database_path) {
  return database_path + ".index";
}

}  // namespace remomask::index
