#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "db/database.h"
#include "remomask/progress.h"

namespace remomask::index {

struct VectorIndexOptions {
  /// What to build, in the syntax of FAISS's index_factory: "Flat" (exact) or an approximate type
  /// such as "IVF256,Flat" or "HNSW32". "auto" chooses by the number of vectors (resolve_factory in
  /// faiss_index.h).
  std::string factory = "auto";
  /// How an approximate type searches, for example "nprobe=16" or "efSearch=64". Empty: FAISS's
  /// default, or for "auto" the smallest nprobe with a recall of 0.97.
  std::string search_parameters;
};

/// The kind of index that was built.
struct IndexType {
  std::string requested;  ///< "auto", or the same as `factory`
  std::string factory;
  std::string search_parameters;
  /// Share of the true ten nearest neighbours that a search finds, measured when the index was
  /// built, with 100 stored vectors as queries; unset for "Flat", which is exact.
  std::optional<double> recall;
};

/// The database and the state of it that an index holds.
struct IndexStamp {
  std::string database_uuid;
  int64_t generation = 0;
  std::string retriever_hash;
  std::string writer = "";  ///< Database::writer_of(generation)
};

struct VectorHit {
  int64_t clip_id = 0;
  float similarity = 0;  ///< cosine, -1 .. 1
};

/// The number of clips that a new state added and dropped.
struct IndexDifference {
  int64_t added = 0, dropped = 0;
};

/// The motion vectors of all embedded clips, ready to be searched: a cache that can be rebuilt from
/// the database at any time. It consists of a base, as it was built, and of the changes since:
/// dropped clips and added vectors. Const functions may be called from several threads.
class VectorIndex {
 public:
  /// Builds from the vectors that `retriever_hash` made. Throws Error if there are none, if one is
  /// not L2-normalised, or for a wrong option, and Interrupted if the monitor's stop token requests
  /// it.
  static VectorIndex build(const db::Database& database, const std::string& retriever_hash,
                           const VectorIndexOptions& options = {}, const Monitor& monitor = {});

  /// The same from memory: `vectors` [ids][width], L2-normalised, any order of ids.
  VectorIndex(IndexStamp stamp, const std::vector<int64_t>& ids, const std::vector<float>& vectors,
              int width, const VectorIndexOptions& options = {}, const Monitor& monitor = {});

  /// Reads what save() wrote and follows the database to its present state. Throws FileError if a
  /// file is missing, truncated or damaged, and Error if the index belongs to another database, a
  /// later state or another retriever.
  static VectorIndex open(const std::string& path, const db::Database& database,
                          const std::string& retriever_hash);

  ~VectorIndex();
  VectorIndex(VectorIndex&&) noexcept;
  VectorIndex& operator=(VectorIndex&&) noexcept;

  /// Takes over the changes of the database that this index was built from, at the cost of a list
  /// of ids and the new vectors. Throws Error for another database.
  IndexDifference follow(const db::Database& database);

  /// Writes atomically. If `path` holds the base of this index, only the changes are written, to a
  /// small file beside it (delta_path in index_changes.h), unless they warrant a new base. A base
  /// file begins with a plain FAISS index (IDMap2), which FAISS reads by itself.
  void save(const std::string& path);

  /// The `k` clips nearest to each of the `queries` [query_count][width] (L2-normalised), best
  /// first, equal similarities by clip id; fewer only if there are fewer clips. `allowed` (clip
  /// ids, ascending) limits the search. Exact for "Flat" and whenever `allowed` is given; other
  /// types may miss clips, but the similarities that they return are exact.
  std::vector<std::vector<VectorHit>> search(const float* queries, int64_t query_count, int64_t k,
                                             const std::vector<int64_t>* allowed = nullptr) const;

  /// Throws Error if the index is not of the present state of `database`.
  void require_current(const db::Database& database) const;

  int64_t count() const;
  int width() const;
  const IndexType& type() const;
  const IndexStamp& stamp() const;
  const std::vector<int64_t>& clip_ids() const;  ///< ascending

 private:
  struct Impl;
  explicit VectorIndex(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Where the index of a database is unless the user says otherwise.
std::string default_index_path(const std::string& database_path);

}  // namespace remomask::index
