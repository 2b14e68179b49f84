#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "db/database.h"
#include "index/vector_index.h"

namespace remomask::index {

/// A query that is linear in a clip's vectors: similarity = global . clip.motion
/// + parts . clip.parts.
struct LinearQuery {
  std::vector<float> global;  ///< [E]
  std::vector<float> parts;   ///< [6 P]; empty: the parts do not count
};

/// Vectors of clips for exact scans of what the index does not hold.
class VectorTable {
 public:
  /// One row [motion | six parts] for each clip. Throws Error if the widths differ.
  static VectorTable of_bodies(const std::vector<db::ClipEmbedding>& embeddings);
  /// Text vectors of the clips that have captions.
  static VectorTable of_captions(const std::vector<db::ClipEmbedding>& embeddings);

  /// The `k` best clips, best first, equal similarities by clip id; `allowed` (clip ids, ascending)
  /// limits the scan. Similarities are summed in double and rounded.
  std::vector<VectorHit> nearest(const LinearQuery& query, int64_t k,
                                 const std::vector<int64_t>* allowed = nullptr) const;

  int64_t count() const { return static_cast<int64_t>(ids_.size()); }

 private:
  VectorTable(int global_width, int parts_width)
      : global_width_(global_width), parts_width_(parts_width) {}
  void add(int64_t id, const std::vector<float>& global, const std::vector<float>& parts);

  int global_width_ = 0, parts_width_ = 0;
  std::vector<int64_t> ids_;
  std::vector<float> rows_;  ///< each scaled to length 1, as the exact scan requires
};

}  // namespace remomask::index
