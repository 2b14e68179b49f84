#pragma once

#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "remomask/search.h"

namespace remomask::search {

/// Steps from one word to the other: a letter more, less, another one, or two neighbours exchanged
/// (optimal string alignment); `limit` + 1 when there are more.
int edit_distance(const std::string& from, const std::string& to, int limit);

/// Shorter words are left as they are: too many others are a step away.
inline constexpr size_t kMinSpelledLetters = 4;

/// A sentence without its typing errors.
struct SpelledSentence {
  std::string text;
  std::vector<CorrectedWord> corrected;
};

/// Replaces every word that `is_word` does not know by the nearest one of `vocabulary` (word -> how
/// often it occurs) with the same first letter: one step away, or two for words of nine letters and
/// more; of several the most frequent. The rest of the sentence stays as it is.
SpelledSentence correct_spelling(const std::string& sentence,
                                 const std::function<bool(const std::string&)>& is_word,
                                 const std::unordered_map<std::string, int>& vocabulary);

}  // namespace remomask::search
