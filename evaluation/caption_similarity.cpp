#include "evaluation/caption_similarity.h"

#include <cctype>
#include <cmath>
#include <map>

#include "text/caption.h"
#include "text/words.h"

namespace remomask::evaluation {

CaptionSimilarity::CaptionSimilarity(const std::vector<std::string>& captions)
    : words_of_(captions.size()) {
  std::map<std::string, size_t> numbers;
  for (size_t i = 0; i < captions.size(); ++i) {
    std::map<size_t, float> counts;
    for (const std::string& word : text::split_words(text::normalise_caption(captions[i]))) {
      if (word.size() == 1 && std::ispunct(static_cast<unsigned char>(word[0]))) continue;
      counts[numbers.emplace(word, numbers.size()).first->second] += 1;
    }
    words_of_[i].assign(counts.begin(), counts.end());
  }
  std::vector<size_t> captions_with(numbers.size());
  for (const auto& words : words_of_) {
    for (const Entry& entry : words) ++captions_with[entry.first];
  }
  captions_of_.resize(numbers.size());
  for (size_t i = 0; i < words_of_.size(); ++i) {
    double squares = 0;
    for (auto& [word, weight] : words_of_[i]) {
      weight *= static_cast<float>(std::log(static_cast<double>(1 + captions.size()) /
                                            static_cast<double>(1 + captions_with[word])) +
                                   1);
      squares += weight * weight;
    }
    for (auto& [word, weight] : words_of_[i]) {
      weight /= static_cast<float>(std::sqrt(squares));
      captions_of_[word].emplace_back(i, weight);
    }
  }
}

std::vector<float> CaptionSimilarity::row(size_t i) const {
  std::vector<float> cosines(words_of_.size());
  for (const auto& [word, weight] : words_of_[i]) {
    for (const auto& [caption, other] : captions_of_[word]) cosines[caption] += weight * other;
  }
  return cosines;
}

}  // namespace remomask::evaluation
