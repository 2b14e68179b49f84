#pragma once

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "db/database.h"
#include "index/vector_index.h"
#include "index/vector_table.h"
#include "search/calibration.h"
#include "search/caption_table.h"
#include "search/word_index.h"

namespace remomask::search {

/// One state of a database, shared by all searches in it.
struct SearchState {
  index::VectorIndex index;
  std::vector<db::Clip> clips;                                   ///< by id
  std::unordered_map<std::string, std::vector<int64_t>> groups;  ///< Clip::group -> ids
  /// Of clips without captions.
  std::unordered_map<int64_t, std::vector<db::GuessedCaption>> guesses;
  std::shared_ptr<const index::VectorTable> bodies, captions;  ///< read when first needed
  std::shared_ptr<const CaptionTable> caption_table;           ///< likewise
  std::shared_ptr<const WordIndex> word_index;                 ///< likewise

  SearchState(index::VectorIndex vector_index, std::vector<db::Clip> all_clips,
              const std::vector<db::GuessedCaption>& all_guesses = {});

  const db::Clip& clip(int64_t id) const { return clips[place(id)]; }
  size_t place(int64_t id) const;  ///< in `clips`
  /// The captions of a clip, guessed ones where nobody wrote some.
  std::vector<std::string> captions_of(size_t place) const;
  /// Probability that a caption of the clip says what it shows: 1 for those that people wrote.
  double described(size_t place, const std::string& caption) const;
};

/// All that one search reads from the database.
struct SearchScene {
  std::shared_ptr<const SearchState> state;
  std::shared_ptr<const index::VectorTable> bodies, captions;
  std::shared_ptr<const CaptionTable> caption_table;  ///< of a search by words
  std::shared_ptr<const WordIndex> word_index;        ///< likewise
  std::optional<std::vector<int64_t>> allowed;        ///< ids that pass the filter, ascending
  std::vector<int64_t> boosted;                       ///< have boost words, best first
  std::optional<Calibration> calibration;             ///< of queries by a sentence alone
  std::optional<db::ClipEmbedding> like;              ///< vectors of SearchQuery::like_clip

  const std::vector<int64_t>* limit() const { return allowed ? &*allowed : nullptr; }
  /// How many of these clips are embedded and pass the filter.
  int64_t candidates(const std::vector<int64_t>& ids) const;
};

}  // namespace remomask::search
