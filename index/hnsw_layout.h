#pragma once

#include "index/layout_walk.h"

namespace remomask::index {

/// Walks through the graph of an HNSW index of `count` vectors: every list that a search can come
/// to lies in the bytes, and names vectors that exist on its level.
bool walk_hnsw_graph(LayoutWalk& walk, int64_t count);

}  // namespace remomask::index
