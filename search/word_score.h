#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace remomask::search {

/// What is known of a sentence and one clip.
struct WordFeatures {
  bool captions = false;  ///< the clip has captions; without, only `motion` counts
  double described = 1;   ///< probability that they say what it shows; below 1 for guessed ones
  double best = 0;        ///< highest cosine of the sentence and a caption
  double mean = 0;        ///< mean cosine over the captions
  double words = 0;       ///< BM25 of the best caption, divided by the highest of all clips
  /// Share of the sentence's content words that stand in the captions, each by its weight
  /// ln(1 + clips / clips with it): a word that no clip has weighs most.
  double share = 0;
  bool other_side = false;       ///< the sentence says left, the caption right, or the reverse
  std::optional<double> motion;  ///< cosine of sentence and motion; none: not embedded
};

/// The probability that a clip shows what a sentence asks for: a logistic regression on the
/// features, one for clips with captions and one for those without.
struct WordScore {
  double bias = 0, best = 0, mean = 0, words = 0, other_side = 0, motion = 0, share = 0;
  double motion_only_bias = 0, motion_only = 0;

  /// The log-odds. A motion that is not embedded counts as one of cosine 0. Guessed captions count
  /// by their probability, and the motion alone for the rest.
  double logit(const WordFeatures& features) const;
  double probability(const WordFeatures& features) const;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WordScore, bias, best, mean, words, other_side, motion, share,
                                   motion_only_bias, motion_only)

/// A hit whose rightness is known.
struct JudgedFeatures {
  WordFeatures features;
  bool right = false;
};

/// Maximum likelihood with a penalty of `ridge` / 2 per squared weight (Newton's method). `worded`
/// are hits of a search by everything, `moving` those of a search by motion. Weights of best, mean,
/// words, share and motion are kept from falling below 0: a clip must not become less probable by
/// resembling the sentence more. That of other_side is -6. Throws Error for fewer than 20 pairs of
/// a kind, or pairs that are all right or all wrong.
WordScore fit_word_score(const std::vector<JudgedFeatures>& worded,
                         const std::vector<JudgedFeatures>& moving, double ridge = 1e-2);

}  // namespace remomask::search
