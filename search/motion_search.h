#pragma once

#include <memory>
#include <string>
#include <vector>

#include "remomask/search.h"
#include "retriever/retriever.h"
#include "search/query.h"
#include "search/word_model.h"

namespace remomask::search {

/// A clip that is similar to a sentence, with its vectors.
struct FoundClip {
  MotionHit hit;
  std::vector<float> motion;  ///< global vector [E]
  std::vector<float> text;    ///< mean of the captions [E]; empty for a clip without captions
};

/// The clips that answer a sentence, and what they say of its words.
struct FoundClips {
  std::vector<FoundClip> clips;
  std::vector<QueryWord> words;
};

/// Search in a motion database: a model's retriever, the database and its index.
/// Const functions may be called from several threads; they take turns at the
/// database, a search by words also at its sentence encoder, and work side by side otherwise. Every
/// search sees one state of the database, including changes that other programs made since the last
/// search.
class MotionSearch {
 public:
  /// `index_path` empty: beside the database. Throws Error if a file is missing or damaged, or
  /// if the retriever has not embedded the database.
  /// Without `words` sentences are compared with motions alone (SearchBy::motion).
  MotionSearch(std::shared_ptr<const retriever::Retriever> retriever,
               std::shared_ptr<const WordModel> words, const std::string& database_path,
               const std::string& index_path = "");
  ~MotionSearch();
  MotionSearch(MotionSearch&&) noexcept;
  MotionSearch& operator=(MotionSearch&&) noexcept;

  /// See TextToMotion::search().
  SearchAnswer search(const SearchQuery& query) const;

  /// See TextToMotion::captions_for().
  std::vector<CaptionHit> captions_for(const SearchQuery& query) const;

  /// The `k` clips most similar to a vector of the retriever's space [E], one of each group, best
  /// first.
  std::vector<FoundClip> nearest(const std::vector<float>& query, int k,
                                 const ClipFilter& filter) const;

  /// The `k` best hits of SearchBy::all for a sentence, one of each group, with their vectors; a
  /// hit that is meant as its mirror image has those of the clip as it is stored.
  FoundClips find(const std::string& sentence, int k, const ClipFilter& filter) const;

  /// The joints of a stored clip. Throws Error for a clip that is not there.
  Motion motion(int64_t clip_id) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace remomask::search
