#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "db/word_stems.h"

namespace remomask::search {

/// A word that people write as one, with a hyphen or as two: "pushups", "push-ups", "push ups".
struct Compound {
  size_t first = 0, count = 1;  ///< the words of the text that it is written with
  std::string stem;             ///< the same for all spellings and forms: "pushup"
  std::string spelling;         ///< the usual one of this form: "push-ups"
};

/// The compounds among the words of a text. Only those of movements that are in a list: which two
/// words are one cannot be told from the words ("he pushes up", "a left hand"). "Push up" without a
/// hyphen is one in the plural and after an article.
std::vector<Compound> find_compounds(const std::string& text,
                                     const std::vector<db::StemmedWord>& words);

/// The text with all compounds in their usual spelling.
std::string usual_spelling(const std::string& text, const db::WordStems& stems);

}  // namespace remomask::search
