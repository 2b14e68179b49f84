#include "index/hnsw_layout.h"

#include <algorithm>
#include <vector>

namespace remomask::index {

namespace {

constexpr uint64_t kMaxLevels = 64;

/// As faiss/impl/HNSW.h has it.
struct Graph {
  std::vector<int32_t> sums;    ///< neighbours of a vector below each level
  std::vector<int32_t> levels;  ///< of each vector, at least one
  std::vector<uint64_t> offsets;
  std::vector<int32_t> neighbours;  ///< -1: none
};

bool has_sound_lists(const Graph& graph) {
  const std::vector<int32_t>& sums = graph.sums;
  if (sums.empty() || sums[0] != 0 || !std::is_sorted(sums.begin(), sums.end())) return false;
  for (size_t i = 0; i < graph.levels.size(); ++i) {
    const int32_t levels = graph.levels[i];
    if (levels < 1 || static_cast<size_t>(levels) >= sums.size()) return false;
    const uint64_t length = static_cast<uint64_t>(sums[static_cast<size_t>(levels)]);
    if (graph.offsets[i] > graph.neighbours.size() ||
        graph.neighbours.size() - graph.offsets[i] < length ||
        graph.offsets[i + 1] != graph.offsets[i] + length) {
      return false;
    }
  }
  return true;
}

/// Of lists that are sound: a search that goes down from a level never finds a vector that does not
/// reach up to it.
bool has_sound_neighbours(const Graph& graph) {
  const auto count = static_cast<int64_t>(graph.levels.size());
  for (size_t i = 0; i < graph.levels.size(); ++i) {
    for (int32_t level = 0; level < graph.levels[i]; ++level) {
      const auto at = static_cast<size_t>(level);
      const uint64_t end = graph.offsets[i] + static_cast<uint64_t>(graph.sums[at + 1]);
      for (uint64_t k = graph.offsets[i] + static_cast<uint64_t>(graph.sums[at]); k < end; ++k) {
        const int32_t other = graph.neighbours[k];
        if (other < -1 || other >= count) return false;
        if (other >= 0 && graph.levels[static_cast<size_t>(other)] <= level) return false;
      }
    }
  }
  return true;
}

}  // namespace

bool walk_hnsw_graph(LayoutWalk& walk, int64_t count) {
  Graph graph;
  std::vector<double> probabilities;
  int32_t entry = 0, top = 0;
  // And the widths of building and searching, and of the beam above the lowest level.
  const bool taken = walk.take_vector(probabilities, kMaxLevels) &&
                     walk.take_vector(graph.sums, kMaxLevels) && walk.take_vector(graph.levels) &&
                     walk.take_vector(graph.offsets) && walk.take_vector(graph.neighbours) &&
                     walk.take(entry) && walk.take(top) && walk.skip(3, sizeof(int32_t));
  if (!taken || graph.levels.size() != static_cast<size_t>(count) ||
      graph.offsets.size() != graph.levels.size() + 1 || !has_sound_lists(graph) ||
      !has_sound_neighbours(graph)) {
    return false;
  }
  if (count == 0) return entry == -1;
  return entry >= 0 && entry < count && top >= 0 && top < graph.levels[static_cast<size_t>(entry)];
}

}  // namespace remomask::index
