#pragma once

#include <vector>

#include "db/database.h"
#include "index/filter.h"
#include "index/vector_index.h"

namespace remomask {

struct SearchHit {
  Clip clip;
  float similarity = 0;  ///< cosine
  int rank = 0;          ///< from 1
};

/// Which hits count as one; the best of them is kept.
enum class Collapse {
  none,
  mirrors,  ///< a stored mirror copy and its original
  groups,   ///< all clips of one Clip::group
};

struct SearchOptions {
  int k = 10;
  ClipFilter filter;
  Collapse collapse = Collapse::none;
};

/// The best clips for each query (L2-normalised, [queries][index.width()]), one
/// list a query, best first; fewer than k when no more are there. Reads one
/// state of the database; clips that it has gained since the index followed it
/// are not found, those that it has lost are left out. Throws Error when the
/// index belongs to another database.
std::vector<std::vector<SearchHit>> search_database(const Database& database,
                                                    const VectorIndex& index, const float* queries,
                                                    int64_t query_count,
                                                    const SearchOptions& options = {});

}  // namespace remomask
