#include "search/compounds.h"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "search/lower_case.h"

namespace remomask::search {

namespace {

struct Entry {
  std::string first, second;
  std::string between;           ///< "", " " or "-" in the usual spelling
  bool also_verb = false;        ///< without a hyphen it may be a verb and its adverb
  std::string closed_stem = "";  ///< of both written as one
};

/// By the stem of the first part.
using Entries = std::unordered_multimap<std::string, Entry>;

const Entries& entries() {
  static const Entries known = [] {
    const db::WordStems stems;
    const Entry list[] = {
        {"push", "up", "-", true},       {"pull", "up", "-", true},
        {"sit", "up", "-", true},        {"chin", "up", "-", true},
        {"press", "up", "-", true},      {"warm", "up", "-", true},
        {"knock", "out", "", true},      {"jumping", "jack", " ", false},
        {"star", "jump", " ", false},    {"front", "flip", " ", false},
        {"high", "five", " ", false},    {"fist", "bump", " ", false},
        {"cross", "legged", "-", false}, {"back", "flip", "", false},
        {"cart", "wheel", "", false},    {"hand", "stand", "", false},
        {"head", "stand", "", false},    {"hand", "shake", "", false},
        {"side", "step", "", false},     {"moon", "walk", "", false},
        {"tip", "toe", "", false},       {"round", "house", "", false},
        {"upper", "cut", "", false},     {"break", "dance", "", false},
        {"leap", "frog", "", false},     {"hop", "scotch", "", false},
        {"somer", "sault", "", false},   {"belly", "dance", " ", false},
    };
    Entries by_first;
    for (Entry entry : list) {
      entry.closed_stem = stems.stem(entry.first + entry.second);
      const std::string first = stems.stem(entry.first);
      entry.second = stems.stem(entry.second);
      by_first.emplace(first, std::move(entry));
    }
    return by_first;
  }();
  return known;
}

/// Both parts of a closed word by its stem.
const std::unordered_map<std::string, const Entry*>& closed_words() {
  static const std::unordered_map<std::string, const Entry*> known = [] {
    std::unordered_map<std::string, const Entry*> by_stem;
    for (const auto& [first, entry] : entries()) by_stem.emplace(entry.closed_stem, &entry);
    return by_stem;
  }();
  return known;
}

std::string typed_word(const std::string& text, const db::StemmedWord& word) {
  return text.substr(word.begin, word.end - word.begin);
}

bool is_determiner(const std::string& word) {
  static const std::unordered_set<std::string> articles = {"a",   "an",  "the",   "one",
                                                           "his", "her", "their", "another"};
  return articles.contains(word);
}

std::optional<Compound> compound_of_two(const std::string& text,
                                        const std::vector<db::StemmedWord>& words, size_t place) {
  const db::StemmedWord &left = words[place], &right = words[place + 1];
  const std::string between = text.substr(left.end, right.begin - left.end);
  if (between != "-" && between.find_first_not_of(' ') != std::string::npos) return std::nullopt;
  const auto [begin, end] = entries().equal_range(left.stem);
  for (auto one = begin; one != end; ++one) {
    const Entry& entry = one->second;
    const std::string first = typed_word(text, left), second = typed_word(text, right);
    // "jumps jack" and "tips toe" are none.
    if (right.stem != entry.second || lower_case(first) != entry.first) continue;
    const bool plural = second.back() == 's' || second.back() == 'S';
    const bool named = place > 0 && is_determiner(lower_case(typed_word(text, words[place - 1])));
    if (entry.also_verb && between != "-" && !plural && !named) continue;
    return Compound{place, 2, entry.closed_stem, first + entry.between + second};
  }
  return std::nullopt;
}

std::optional<Compound> closed_compound(const std::string& text,
                                        const std::vector<db::StemmedWord>& words, size_t place) {
  const auto found = closed_words().find(words[place].stem);
  if (found == closed_words().end()) return std::nullopt;
  const std::string word = typed_word(text, words[place]);
  const size_t split = found->second->first.size();
  return Compound{place, 1, words[place].stem,
                  word.substr(0, split) + found->second->between + word.substr(split)};
}

}  // namespace

std::vector<Compound> find_compounds(const std::string& text,
                                     const std::vector<db::StemmedWord>& words) {
  std::vector<Compound> compounds;
  for (size_t i = 0; i < words.size(); ++i) {
    std::optional<Compound> found;
    if (i + 1 < words.size()) found = compound_of_two(text, words, i);
    if (!found) found = closed_compound(text, words, i);
    if (!found) continue;
    i += found->count - 1;
    compounds.push_back(std::move(*found));
  }
  return compounds;
}

std::string usual_spelling(const std::string& text, const db::WordStems& stems) {
  const std::vector<db::StemmedWord> words = stems.read(text);
  std::string usual;
  size_t done = 0;
  for (const Compound& compound : find_compounds(text, words)) {
    usual += text.substr(done, words[compound.first].begin - done) + compound.spelling;
    done = words[compound.first + compound.count - 1].end;
  }
  return usual + text.substr(done);
}

}  // namespace remomask::search
