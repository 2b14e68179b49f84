#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "db/word_stems.h"

namespace remomask::search {

/// A word of a query, as the captions may have it.
struct QueryTerm {
  std::string stem;
  int32_t number = -1;  ///< of the index; -1: no text has it
};

/// What the words of a query mean for each clip.
struct WordMatches {
  std::vector<float> bm25;   ///< of the best text, divided by the highest of all clips
  std::vector<float> share;  ///< WordFeatures::share
};

/// The words of what is said of each clip, its captions and its tags, held in memory: BM25 as
/// SQLite's FTS5 counts it (k1 1.2, b 0.75), with its stems, in a time that FTS5 needs for a
/// hundred captions. All of its functions may be called from several threads.
class WordIndex {
 public:
  /// `texts_of(place)` gives the texts of each of the clips.
  WordIndex(size_t clips, const std::function<std::vector<std::string>(size_t)>& texts_of);

  /// The content words, each once; a compound is one of them.
  std::vector<QueryTerm> terms(const std::string& sentence) const;
  WordMatches match(const std::vector<QueryTerm>& terms) const;
  /// Whether the texts of a clip have all of these.
  bool clip_has(size_t place, const std::vector<QueryTerm>& terms) const;
  /// Whether a text has the word in any of its forms.
  bool has_word(const std::string& word) const;

  /// Words as they are written, in lower case, with how often they occur.
  const std::unordered_map<std::string, int>& vocabulary() const { return vocabulary_; }
  const db::WordStems& stems() const { return stems_; }

 private:
  class Builder;
  struct Posting {
    int32_t text = 0, count = 0;
  };
  struct Postings {
    size_t first = 0, last = 0;  ///< in postings_
    int32_t texts = 0;           ///< that have the word, each as often as clips have it
    int32_t clips = 0;
  };

  double weight(const QueryTerm& term) const;
  const int32_t* find(const std::string& stem) const;

  db::WordStems stems_;
  std::unordered_map<std::string, int32_t> numbers_;
  std::unordered_map<std::string, int> vocabulary_;
  std::vector<Postings> terms_;
  std::vector<Posting> postings_;     // by term, then by text
  std::vector<float> length_factor_;  // of each text: k1 (1 - b + b length / mean length)
  std::vector<size_t> first_;         // of each clip in texts_, and the end
  std::vector<int32_t> texts_;        // of the clips
  double text_count_ = 0;             // each as often as clips have it
};

/// The words of a text that say something by themselves, as they are typed; hyphens and apostrophes
/// inside a word belong to it.
std::vector<std::string> content_words(const std::string& text);

}  // namespace remomask::search
