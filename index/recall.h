#pragma once

#include <cstdint>
#include <vector>

#include "index/index_segments.h"

namespace remomask::index {

/// Stored vectors as queries, with their true ten nearest neighbours.
class RecallSample {
 public:
  /// Takes 100 rows, evenly spread, or all rows of a smaller index.
  explicit RecallSample(const IndexSegments& segments);

  /// Share of the true ten that an approximate search finds, 0 .. 1.
  double measure(const IndexSegments& segments) const;

 private:
  std::vector<int64_t> ids_;  ///< of the queries
  std::vector<float> queries_;
  std::vector<std::vector<VectorHit>> truth_;  ///< without the query itself
};

/// Sets the number of lists that an IVF index visits to the smallest power of two with a recall of
/// 0.97 and returns it as a search parameter; "" for other types.
std::string tune_probes(IndexSegments& segments, const RecallSample& sample);

}  // namespace remomask::index
