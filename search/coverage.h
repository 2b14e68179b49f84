#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "encoders/sentence_encoder.h"
#include "remomask/search.h"

namespace remomask::search {

/// The cosine of vectors of length 1.
double dot_product(const std::vector<float>& left, const std::vector<float>& right);

/// Words that say nothing by themselves in a description of a motion: articles, pronouns,
/// prepositions, auxiliary verbs, and the one who moves (person, man, girl, robot).
bool is_function_word(const std::string& word);

/// What the captions of the best hits say of a sentence's words.
struct CoverageQuestion {
  std::string sentence;
  /// The nearest captions, some tens of them; asked for only where a word stands in none.
  std::function<std::vector<std::string>()> nearest_captions;
  /// Whether a caption of the best hits has a word in any of its forms.
  std::function<bool(const std::string& word)> in_captions;
};

/// For each content word of the sentence the probability that the captions say it. A word that
/// stands in them is covered; another one is as covered as the highest cosine of its state in the
/// encoder's last layer with the state of a word there says (words that are there: 0.65 to 0.97;
/// words that are not: 0.24 to 0.50).
std::vector<QueryWord> covered_words(const encoders::SentenceEncoder& encoder,
                                     const CoverageQuestion& question);

}  // namespace remomask::search
