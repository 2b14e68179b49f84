#include "search/search_scene.h"

#include <algorithm>

namespace remomask::search {

SearchState::SearchState(index::VectorIndex vector_index, std::vector<db::Clip> all_clips,
                         const std::vector<db::GuessedCaption>& all_guesses)
    : index(std::move(vector_index)), clips(std::move(all_clips)) {
  for (const db::Clip& clip : clips) groups[clip.group].push_back(clip.id);
  for (const db::GuessedCaption& guess : all_guesses) guesses[guess.clip_id].push_back(guess);
}

size_t SearchState::place(int64_t id) const {
  const auto clip =
      std::lower_bound(clips.begin(), clips.end(), id,
                       [](const db::Clip& left, int64_t value) { return left.id < value; });
  return static_cast<size_t>(clip - clips.begin());
}

std::vector<std::string> SearchState::captions_of(size_t place) const {
  const db::Clip& clip = clips[place];
  const auto guessed = guesses.find(clip.id);
  if (!clip.captions.empty() || guessed == guesses.end()) return clip.captions;
  std::vector<std::string> texts;
  for (const db::GuessedCaption& guess : guessed->second) texts.push_back(guess.text);
  return texts;
}

double SearchState::described(size_t place, const std::string& caption) const {
  if (guesses.empty() || !clips[place].captions.empty()) return 1;
  const auto guessed = guesses.find(clips[place].id);
  if (guessed == guesses.end()) return 1;
  const auto guess =
      std::find_if(guessed->second.begin(), guessed->second.end(),
                   [&](const db::GuessedCaption& one) { return one.text == caption; });
  return guess == guessed->second.end() ? 1 : guess->probability;
}

int64_t SearchScene::candidates(const std::vector<int64_t>& ids) const {
  const auto& indexed = state->index.clip_ids();
  return std::count_if(ids.begin(), ids.end(), [&](int64_t id) {
    return std::binary_search(indexed.begin(), indexed.end(), id) &&
           (!allowed || std::binary_search(allowed->begin(), allowed->end(), id));
  });
}

}  // namespace remomask::search
