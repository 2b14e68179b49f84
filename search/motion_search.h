#pragma once

#include <memory>
#include <string>
#include <vector>

#include "search/query.h"
#include "search/search_answer.h"

namespace remomask::search {

/// Search in a motion database: a model's retriever, the database and its index.
/// Const functions may be called from several threads; they take turns at the
/// database and work side by side otherwise. Every search sees one state of the
/// database, and changes that other programs have made since the last one.
class MotionSearch {
 public:
  /// `index_path` empty: beside the database. Throws Error when a file is
  /// missing or damaged, or when the retriever has not embedded the database.
  MotionSearch(const std::string& model_path, const std::string& database_path,
               const std::string& index_path = "");
  ~MotionSearch();
  MotionSearch(MotionSearch&&) noexcept;
  MotionSearch& operator=(MotionSearch&&) noexcept;

  /// The best clips. With `like_clip`, that clip is left out, and its group too
  /// where hits are grouped; unwanted words leave out clips one of whose captions
  /// has such a word (by its stem). Exact, but for approximate index types, which
  /// only serve queries without filter, words and body parts. Throws Error for
  /// bad queries.
  SearchAnswer search(const SearchQuery& query) const;

  /// Motion to text: the captions of the 50 clips whose mean text vectors are
  /// nearest to the motion (`motion` or `like_clip` of the query, `filter`),
  /// the `k` best by their own cosine. Equal captions are listed once.
  std::vector<CaptionHit> captions_for(const SearchQuery& query) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace remomask::search
