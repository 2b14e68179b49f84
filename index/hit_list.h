#pragma once

#include <optional>
#include <vector>

#include "index/query.h"
#include "index/search_answer.h"
#include "index/search_scene.h"

namespace remomask {

/// The hits of a query: the nearest clips that the scene allows, one a group and
/// above the limits as the query says.
SearchAnswer collect_hits(const SearchScene& scene, const SearchQuery& query,
                          const LinearQuery& vectors);

}  // namespace remomask
