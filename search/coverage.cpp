#include "search/coverage.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_set>

#include "search/word_index.h"

namespace remomask::search {

namespace {

// In the middle between words that are not there (up to 0.50) and words that are (from 0.65 on);
// chosen, not fitted.
constexpr double kEvenCosine = 0.575, kCosineScale = 0.035;

double nearest_state(const encoders::WordState& word,
                     const std::vector<std::vector<encoders::WordState>>& captions) {
  double nearest = -1;
  for (const auto& caption : captions) {
    for (const encoders::WordState& other : caption) {
      if (is_function_word(other.normal)) continue;
      nearest = std::max(nearest, dot_product(word.state, other.state));
    }
  }
  return nearest;
}

}  // namespace

double dot_product(const std::vector<float>& left, const std::vector<float>& right) {
  return std::inner_product(left.begin(), left.end(), right.begin(), 0.0);
}

bool is_function_word(const std::string& word) {
  static const std::unordered_set<std::string> words = {
      "a",         "an",        "the",    "this",    "that",    "these",      "those",   "some",
      "any",       "my",        "your",   "his",     "her",     "their",      "its",     "our",
      "i",         "you",       "he",     "she",     "it",      "we",         "they",    "me",
      "him",       "them",      "us",     "himself", "herself", "themselves", "itself",  "who",
      "which",     "there",     "here",   "is",      "are",     "was",        "were",    "be",
      "been",      "being",     "am",     "do",      "does",    "did",        "has",     "have",
      "had",       "will",      "would",  "can",     "could",   "should",     "and",     "or",
      "but",       "then",      "while",  "as",      "so",      "if",         "when",    "of",
      "to",        "in",        "on",     "at",      "by",      "for",        "from",    "with",
      "into",      "onto",      "over",   "about",   "through", "after",      "before",  "during",
      "very",      "just",      "really", "now",     "please",  "like",       "also",    "again",
      "not",       "no",        "person", "people",  "human",   "man",        "woman",   "men",
      "women",     "guy",       "girl",   "boy",     "kid",     "child",      "someone", "somebody",
      "one",       "character", "figure", "player",  "actor",   "robot",      "subject", "make",
      "makes",     "making",    "let",    "lets",    "get",     "gets",       "motion",  "movement",
      "animation", "show",      "shows",  "want",    "give"};
  return words.contains(word);
}

std::vector<QueryWord> covered_words(const encoders::SentenceEncoder& encoder,
                                     const CoverageQuestion& question) {
  std::vector<QueryWord> result;
  for (const std::string& word : content_words(question.sentence)) {
    const bool there = question.in_captions(word);
    result.push_back({word, there ? 1.0 : 0.0, there});
  }
  const auto is_there = [](const QueryWord& word) { return word.in_captions; };
  if (std::all_of(result.begin(), result.end(), is_there)) return result;
  // What follows takes longer than all of a search: the encoder reads the captions.
  const std::vector<std::string> nearest = question.nearest_captions();
  if (nearest.empty()) return result;
  const auto captions = encoder.words(nearest);
  for (const encoders::WordState& state : encoder.words(question.sentence)) {
    for (QueryWord& word : result) {
      if (word.in_captions || word.word != state.typed) continue;
      word.covered =
          1 / (1 + std::exp((kEvenCosine - nearest_state(state, captions)) / kCosineScale));
    }
  }
  return result;
}

}  // namespace remomask::search
