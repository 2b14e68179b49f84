#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace remomask::evaluation {

/// Classes of words as the text-motion evaluator of Guo et al. (CVPR 2022) has
/// them: nine parts of speech, five lists of words that matter for motion, the
/// rest. The numbers are the columns of its weights.
enum class WordClass : int64_t {
  verb,
  noun,
  determiner,
  adposition,
  numeral,
  auxiliary,
  pronoun,
  adjective,
  adverb,
  place,        ///< "left", "forward"
  body,         ///< "arm", "knee"
  object,       ///< "stair", "ball"
  act,          ///< "walk", "turn"
  description,  ///< "slowly", "happy"
  other
};
inline constexpr int64_t kWordClasses = 15;

/// A word (lower case) by the five lists, in the order place, body, object, act,
/// description; also when it is an inflection of a listed one. Function words by
/// a list of their own; everything else is `other`: there is no tagger here, so
/// that verb, noun, adjective and adverb are never given.
WordClass word_class(const std::string& word);

/// The word itself and what it may be an inflection of: "waving" -> "waving",
/// "wav", "wave"; irregular forms of the listed verbs too. May hold non-words.
std::vector<std::string> base_forms(const std::string& word);

}  // namespace remomask::evaluation
