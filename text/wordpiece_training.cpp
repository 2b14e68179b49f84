#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "remomask/error.h"
#include "text/utf8.h"
#include "text/wordpiece.h"

namespace remomask::text {

namespace {

using SymbolPair = std::pair<std::string, std::string>;

struct CountedWord {
  std::vector<std::string> symbols;
  int64_t count;
};

struct PairStatistics {
  int64_t count = 0;
  std::set<size_t> words;  ///< that hold the pair, or held it once
};

/// The state of the merges: counts are kept up to date word by word.
class MergeTable {
 public:
  explicit MergeTable(std::vector<CountedWord> words) : words_(std::move(words)) {
    for (size_t i = 0; i < words_.size(); ++i) count_word(i, +1);
  }

  /// The pair with the highest gain; nothing when no pair occurs twice or gains.
  const SymbolPair* best() const {
    const SymbolPair* chosen = nullptr;
    double highest = 0;
    for (const auto& [pair, statistics] : pairs_) {
      if (statistics.count < 2) continue;
      const double n = static_cast<double>(statistics.count);
      const double gain = n * std::log(n * static_cast<double>(total_) /
                                       (static_cast<double>(symbols_.at(pair.first)) *
                                        static_cast<double>(symbols_.at(pair.second))));
      if (gain > highest) {
        highest = gain;
        chosen = &pair;
      }
    }
    return chosen;
  }

  std::string merge(const SymbolPair& pair) {
    const std::string merged = pair.first + pair.second.substr(2);
    const std::set<size_t> affected = pairs_.at(pair).words;
    for (const size_t i : affected) {
      count_word(i, -1);
      auto& symbols = words_[i].symbols;
      for (size_t k = 0; k + 1 < symbols.size(); ++k) {
        if (symbols[k] == pair.first && symbols[k + 1] == pair.second) {
          symbols[k] = merged;
          symbols.erase(symbols.begin() + static_cast<std::ptrdiff_t>(k) + 1);
        }
      }
      count_word(i, +1);
    }
    pairs_.erase(pair);
    return merged;
  }

 private:
  void count_word(size_t index, int64_t sign) {
    const CountedWord& word = words_[index];
    for (size_t k = 0; k < word.symbols.size(); ++k) {
      symbols_[word.symbols[k]] += sign * word.count;
      total_ += sign * word.count;
      if (k + 1 == word.symbols.size()) continue;
      PairStatistics& pair = pairs_[{word.symbols[k], word.symbols[k + 1]}];
      pair.count += sign * word.count;
      if (sign > 0) pair.words.insert(index);
    }
  }

  std::vector<CountedWord> words_;
  std::map<std::string, int64_t> symbols_;
  std::map<SymbolPair, PairStatistics> pairs_;
  int64_t total_ = 0;
};

}  // namespace

std::vector<std::string> train_wordpiece(const std::vector<std::string>& captions, int64_t size) {
  std::map<std::string, int64_t> counts;
  for (const std::string& caption : captions) {
    for (const std::string& word : split_words(caption)) ++counts[word];
  }
  std::set<std::string> characters;
  for (char c = '!'; c <= '~'; ++c) {
    if (c < 'A' || c > 'Z') characters.insert(std::string(1, c));
  }
  std::vector<CountedWord> words;
  for (const auto& [word, count] : counts) {
    CountedWord counted{{}, count};
    for (const char32_t point : decode_utf8(word)) {
      std::string character;
      append_utf8(character, point);
      characters.insert(character);
      counted.symbols.push_back((counted.symbols.empty() ? "" : "##") + character);
    }
    if (!counted.symbols.empty()) words.push_back(std::move(counted));
  }

  std::vector<std::string> vocabulary = {"[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]"};
  for (const std::string& character : characters) vocabulary.push_back(character);
  for (const std::string& character : characters) {
    // ASCII punctuation is always a word of its own.
    const bool punctuation = split_words("a" + character).size() > 1;
    if (!punctuation) vocabulary.push_back("##" + character);
  }
  if (static_cast<int64_t>(vocabulary.size()) > size) {
    throw Error("a vocabulary of " + std::to_string(size) + " tokens cannot hold the " +
                std::to_string(vocabulary.size()) + " characters; choose a larger one");
  }
  std::set<std::string> known(vocabulary.begin(), vocabulary.end());
  MergeTable table(std::move(words));
  while (static_cast<int64_t>(vocabulary.size()) < size) {
    const SymbolPair* best = table.best();
    if (best == nullptr) break;
    const std::string merged = table.merge(SymbolPair(*best));
    if (known.insert(merged).second) vocabulary.push_back(merged);
  }
  return vocabulary;
}

}  // namespace remomask::text
