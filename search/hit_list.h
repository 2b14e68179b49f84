#pragma once

#include <optional>
#include <vector>

#include "remomask/search.h"
#include "search/query.h"
#include "search/search_scene.h"
#include "search/word_ranking.h"

namespace remomask::search {

/// The hits of a query: the nearest clips that the scene allows, one per group and above the limits
/// if the query says so.
SearchAnswer collect_hits(const SearchScene& scene, const SearchQuery& query,
                          const index::LinearQuery& vectors);

/// The same of a sentence, from the ranking of the clips.
SearchAnswer collect_ranked(const SearchScene& scene, const SearchQuery& query,
                            const std::vector<RankedClip>& ranked);

}  // namespace remomask::search
