#include "search/spelling.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "search/lower_case.h"

namespace remomask::search {

namespace {

constexpr size_t kLettersForTwoSteps = 9;

bool is_plain_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

std::string nearest_word(const std::string& word,
                         const std::unordered_map<std::string, int>& vocabulary) {
  int limit = word.size() >= kLettersForTwoSteps ? 2 : 1;
  std::string best;
  int best_count = 0;
  for (const auto& [other, count] : vocabulary) {
    if (other.size() < kMinSpelledLetters - 1 || other[0] != word[0]) continue;
    const int distance = edit_distance(word, other, limit);
    if (distance > limit) continue;
    const bool better = best.empty() || distance < limit || count > best_count ||
                        (count == best_count && other < best);
    if (!better) continue;
    best = other;
    best_count = count;
    limit = distance;
  }
  return best;
}

}  // namespace

int edit_distance(const std::string& from, const std::string& to, int limit) {
  const auto n = static_cast<int>(from.size()), m = static_cast<int>(to.size());
  if (std::abs(n - m) > limit) return limit + 1;
  std::vector<std::vector<int>> steps(static_cast<size_t>(n) + 1,
                                      std::vector<int>(static_cast<size_t>(m) + 1));
  const auto at = [&](int i, int j) -> int& {
    return steps[static_cast<size_t>(i)][static_cast<size_t>(j)];
  };
  for (int i = 0; i <= n; ++i) at(i, 0) = i;
  for (int j = 0; j <= m; ++j) at(0, j) = j;
  for (int i = 1; i <= n; ++i) {
    for (int j = 1; j <= m; ++j) {
      const char a = from[static_cast<size_t>(i) - 1], b = to[static_cast<size_t>(j) - 1];
      at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, at(i - 1, j - 1) + (a != b)});
      const bool exchanged = i > 1 && j > 1 && a == to[static_cast<size_t>(j) - 2] &&
                             b == from[static_cast<size_t>(i) - 2];
      if (exchanged) at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
    }
  }
  return std::min(at(n, m), limit + 1);
}

SpelledSentence correct_spelling(const std::string& sentence,
                                 const std::function<bool(const std::string&)>& is_word,
                                 const std::unordered_map<std::string, int>& vocabulary) {
  SpelledSentence result;
  for (size_t i = 0; i < sentence.size();) {
    size_t end = i;
    while (end < sentence.size() && is_plain_letter(sentence[end])) ++end;
    if (end == i) {
      result.text += sentence[i++];
      continue;
    }
    const std::string typed = sentence.substr(i, end - i);
    const std::string word = lower_case(typed);
    i = end;
    const bool fine =
        word.size() < kMinSpelledLetters || is_word(word) || vocabulary.contains(word);
    const std::string read = fine ? "" : nearest_word(word, vocabulary);
    result.text += read.empty() ? typed : read;
    if (!read.empty()) result.corrected.push_back({typed, read});
  }
  return result;
}

}  // namespace remomask::search
