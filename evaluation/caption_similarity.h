#pragma once

#include <string>
#include <utility>
#include <vector>

namespace remomask::evaluation {

/// Similarity of captions by their words, of no model: cosine of word counts
/// weighted by ln((1 + N) / (1 + n)) + 1, with n of the N captions that have the
/// word (smoothed tf-idf). The order of words and punctuation do not count;
/// captions are normalised first.
class CaptionSimilarity {
 public:
  explicit CaptionSimilarity(const std::vector<std::string>& captions);

  /// Cosines of caption i with each one, in [0, 1]; 1 for captions of equal
  /// words, 0 for one without words.
  std::vector<float> row(size_t i) const;

 private:
  using Entry = std::pair<size_t, float>;
  std::vector<std::vector<Entry>> words_of_;     ///< of a caption: word, weight
  std::vector<std::vector<Entry>> captions_of_;  ///< of a word: caption, weight
};

}  // namespace remomask::evaluation
