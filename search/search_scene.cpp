#include "search/search_scene.h"

#include <algorithm>

namespace remomask::search {

SearchState::SearchState(index::VectorIndex vector_index, std::vector<db::Clip> all_clips)
    : index(std::move(vector_index)), clips(std::move(all_clips)) {
  for (const db::Clip& clip : clips) groups[clip.group].push_back(clip.id);
}

const db::Clip& SearchState::clip(int64_t id) const {
  return *std::lower_bound(clips.begin(), clips.end(), id,
                           [](const db::Clip& left, int64_t value) { return left.id < value; });
}

int64_t SearchScene::candidates(const std::vector<int64_t>& ids) const {
  const auto& indexed = state->index.clip_ids();
  return std::count_if(ids.begin(), ids.end(), [&](int64_t id) {
    return std::binary_search(indexed.begin(), indexed.end(), id) &&
           (!allowed || std::binary_search(allowed->begin(), allowed->end(), id));
  });
}

}  // namespace remomask::search
