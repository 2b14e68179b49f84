#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "db/database.h"

namespace remomask {

struct VectorIndexOptions {
  /// What to build, as FAISS's index_factory reads it: "Flat" (exact), or an
  /// approximate type such as "IVF256,Flat" or "HNSW32".
  std::string factory = "Flat";
  /// How an approximate type searches, for example "nprobe=16" or "efSearch=64".
  std::string search_parameters;
};

/// Which state of which database an index holds.
struct IndexStamp {
  std::string database_uuid;
  int64_t generation = 0;
  std::string retriever_hash;
};

struct VectorHit {
  int64_t clip_id = 0;
  float similarity = 0;  ///< cosine, -1 .. 1
};

/// The motion vectors of all embedded clips, ready to be searched: a cache that
/// can be made again from the database at any time. Const functions may be
/// called from several threads.
class VectorIndex {
 public:
  /// Builds from the vectors that `retriever_hash` made. Throws Error when
  /// there are none, when one is not L2-normalised, or for a wrong option;
  /// Interrupted when the monitor's stop token asks for it.
  static VectorIndex build(const Database& database, const std::string& retriever_hash,
                           const VectorIndexOptions& options = {}, const Monitor& monitor = {});

  /// The same from memory: `vectors` [ids][width], L2-normalised, any order of ids.
  VectorIndex(IndexStamp stamp, const std::vector<int64_t>& ids, const std::vector<float>& vectors,
              int width, const VectorIndexOptions& options = {}, const Monitor& monitor = {});

  /// Reads what save() wrote. Throws FileError when the file is missing, cut
  /// off or damaged; Error when the database has changed since, or when
  /// another retriever made the vectors.
  static VectorIndex load(const std::string& path, const Database& database,
                          const std::string& retriever_hash);

  ~VectorIndex();
  VectorIndex(VectorIndex&&) noexcept;
  VectorIndex& operator=(VectorIndex&&) noexcept;

  /// Writes atomically. The file begins with a plain FAISS index (IDMap2), which
  /// FAISS reads by itself; what this program adds follows behind it.
  void save(const std::string& path) const;

  /// The `k` clips nearest to each of the `queries` [query_count][width]
  /// (L2-normalised), best first, equal similarities by clip id; fewer when
  /// fewer clips are there. `allowed` (clip ids, ascending) limits the search.
  /// Exact for "Flat" and whenever `allowed` is given; other types may miss
  /// clips, but the similarities that they return are exact.
  std::vector<std::vector<VectorHit>> search(const float* queries, int64_t query_count, int64_t k,
                                             const std::vector<int64_t>* allowed = nullptr) const;

  /// Throws Error when the index is not of the present state of `database`.
  void require_current(const Database& database) const;

  int64_t count() const;
  int width() const;
  const std::string& factory() const;
  const IndexStamp& stamp() const;
  const std::vector<int64_t>& clip_ids() const;  ///< ascending

 private:
  struct Impl;
  explicit VectorIndex(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Where the index of a database lies unless the user says otherwise.
std::string default_index_path(const std::string& database_path);

}  // namespace remomask
