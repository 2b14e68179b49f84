#pragma once

#include <optional>
#include <vector>

#include "remomask/search.h"
#include "search/query.h"
#include "search/search_scene.h"

namespace remomask::search {

/// The hits of a query: the nearest clips that the scene allows, one per group and above the limits
/// if the query says so.
SearchAnswer collect_hits(const SearchScene& scene, const SearchQuery& query,
                          const index::LinearQuery& vectors);

}  // namespace remomask::search
