#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "db/database.h"
#include "index/vector_index.h"
#include "retriever/retriever.h"
#include "search/motion_search.h"
#include "search/query.h"
#include "search/search_scene.h"
#include "search/sentence.h"
#include "search/spelling.h"
#include "search/word_model.h"
#include "search/word_ranking.h"

namespace remomask::search {

/// Which vectors of a database a search reads.
enum class VectorsNeeded { index, bodies, captions };

/// A sentence as search understands it, with what the database says of its words.
struct WordedQuery {
  SpelledSentence sentence;
  std::string language;               ///< SearchAnswer::language
  std::vector<WordVariant> variants;  ///< the sentence, and its mirror image if it names a side
};

struct MotionSearch::Impl {
  std::string index_path;
  std::shared_ptr<const retriever::Retriever> retriever;
  std::shared_ptr<const WordModel> words;  ///< none: searches by motion alone
  mutable std::mutex mutex;                // of all that follows
  mutable db::Database database;
  mutable std::shared_ptr<SearchState> state;

  Impl(std::shared_ptr<const retriever::Retriever> shared,
       std::shared_ptr<const WordModel> word_model, const std::string& database_file,
       const std::string& index_file);

  // In motion_search.cpp.

  SearchScene scene(const SearchQuery& query, const Sentence& sentence, VectorsNeeded need) const;
  QueryVectors vectors(const SearchQuery& query, const Sentence& sentence,
                       const SearchScene& scene) const;
  /// [E] of one sentence.
  std::vector<float> text_vector(const std::string& text) const;
  void find_moments(const index::LinearQuery& query, std::vector<MotionHit>& hits) const;
  std::vector<FoundClip> with_vectors(std::vector<MotionHit> hits) const;
  void read_state() const;
  void refresh() const;
  std::optional<std::vector<int64_t>> allowed_clips(const SearchQuery& query,
                                                    const Sentence& sentence) const;
  std::vector<int64_t> boosted_clips(const std::string& boost_words) const;
  int64_t stored_clip(const std::string& name) const;
  std::optional<Calibration> calibration() const;
  db::ClipEmbedding motion_vectors(const Motion& motion) const;
  std::optional<Motion> hit_motion(const ClipInfo& clip) const;

  // In word_search.cpp.

  /// The clips that answer a sentence by its words, captions and motions.
  SearchAnswer search_words(const SearchQuery& query, const Sentence& sentence) const;
  SearchScene word_scene(const SearchQuery& query, const Sentence& sentence) const;
  /// All that such a search reads from the database; what it computes from it needs no lock.
  SearchScene locked_word_scene(const SearchQuery& query, const Sentence& sentence) const;
  WordedQuery worded_query(const SearchQuery& query, const Sentence& sentence,
                           const WordIndex& index) const;
  /// Fills in `language`, too.
  SpelledSentence spelled(const std::string& sentence, const WordIndex& index,
                          std::string& language) const;
  std::vector<QueryWord> coverage(const WordedQuery& worded, const SearchScene& scene,
                                  const std::vector<RankedClip>& ranked) const;
};

}  // namespace remomask::search
