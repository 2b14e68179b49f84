#include "text/caption_mirror.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

namespace remomask::text {

namespace {

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

// Pairs of terms; a hyphen in a term is matched as it stands. "clockwise" can
// stand against one word only if twice is to be the identity, so the spellings
// of its opposite meet spellings of clockwise.
constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kPairs = {{
    {"left", "right"},
    {"lefts", "rights"},
    {"leftward", "rightward"},
    {"leftwards", "rightwards"},
    {"leftmost", "rightmost"},
    {"lefthand", "righthand"},
    {"lefthanded", "righthanded"},
    {"lefty", "righty"},
    {"clockwise", "counterclockwise"},
    {"clock-wise", "counter-clockwise"},
    {"clock wise", "counter clockwise"},
    {"sunwise", "anticlockwise"},
    {"sun-wise", "anti-clockwise"},
    {"clock - wise", "counter clock-wise"},
}};

enum class Letters { lower, capital, upper, mixed };

Letters letters_of(std::string_view text) {
  size_t upper = 0, letters = 0;
  for (const char c : text) {
    if (!is_letter(c)) continue;
    ++letters;
    if (std::isupper(static_cast<unsigned char>(c))) ++upper;
  }
  if (upper == 0) return Letters::lower;
  if (upper == letters) return Letters::upper;
  return upper == 1 && std::isupper(static_cast<unsigned char>(text[0])) ? Letters::capital
                                                                         : Letters::mixed;
}

std::string with_letters(std::string_view lower, Letters letters) {
  std::string result(lower);
  if (letters == Letters::capital) {
    result[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(result[0])));
  } else if (letters == Letters::upper) {
    for (char& c : result) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return result;
}

template <size_t Count>
bool is_one_of(const std::string& word, const std::array<std::string_view, Count>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Word before position `at`, lower case; empty when something other than one
/// blank lies between, as at a sentence's start.
std::string word_before(const std::string& text, size_t at) {
  if (at == 0 || text[at - 1] != ' ') return "";
  size_t first = at - 1;
  while (first > 0 && is_letter(text[first - 1])) --first;
  return lower_case(std::string_view(text).substr(first, at - 1 - first));
}

/// Word after position `at`; moves `at` behind it.
std::string word_after(const std::string& text, size_t& at) {
  if (at >= text.size() || text[at] != ' ') return "";
  const size_t first = at + 1;
  at = first;
  while (at < text.size() && is_letter(text[at])) ++at;
  return lower_case(std::string_view(text).substr(first, at - first));
}

/// "left" as the past tense of "leave": a subject before it and a place behind
/// it ("he left the room"), or "has left" at a clause's end or before an
/// article. Looks at neighbours only, which mirroring does not change, and asks
/// the same of "right", so that the second mirroring decides like the first.
bool means_departed(const std::string& text, size_t first, size_t last) {
  static constexpr std::array<std::string_view, 24> kSubjects = {
      "he",     "she",    "they",  "it",      "who",   "i",        "we",     "you",
      "person", "man",    "woman", "someone", "human", "somebody", "figure", "character",
      "actor",  "people", "boy",   "girl",    "guy",   "dancer",   "child",  "everyone"};
  static constexpr std::array<std::string_view, 4> kAuxiliaries = {"has", "have", "had", "having"};
  static constexpr std::array<std::string_view, 9> kArticles = {
      "the", "a", "an", "his", "her", "their", "its", "this", "that"};
  static constexpr std::array<std::string_view, 24> kPlaces = {
      "room",   "house",  "building", "area",  "place",  "scene", "stage",    "field",
      "door",   "office", "car",      "bed",   "chair",  "table", "seat",     "position",
      "ground", "floor",  "spot",     "court", "street", "party", "platform", "home"};
  const std::string before = word_before(text, first);
  size_t at = last;
  const std::string next = word_after(text, at);
  if (is_one_of(before, kAuxiliaries)) {
    const bool clause_ends = last == text.size() || (text[last] != ' ' && text[last] != '-');
    return clause_ends || is_one_of(next, kArticles);
  }
  if (!is_one_of(before, kSubjects) || !is_one_of(next, kArticles)) return false;
  return is_one_of(word_after(text, at), kPlaces);
}

/// Length of the longest term of the table at `at` and the other side's term.
std::pair<size_t, std::string_view> find_term(const std::string& lower, size_t at) {
  std::pair<size_t, std::string_view> found{0, {}};
  const auto consider = [&](std::string_view term, std::string_view other) {
    if (term.size() <= found.first || lower.compare(at, term.size(), term) != 0) return;
    const size_t end = at + term.size();
    if (end == lower.size() || !is_letter(lower[end])) found = {term.size(), other};
  };
  for (const auto& [a, b] : kPairs) {
    consider(a, b);
    consider(b, a);
  }
  return found;
}

}  // namespace

std::string mirror_caption(const std::string& caption) {
  const std::string lower = lower_case(caption);
  std::string result;
  size_t at = 0;
  while (at < caption.size()) {
    const bool word_starts = is_letter(caption[at]) && (at == 0 || !is_letter(caption[at - 1]));
    if (!word_starts) {
      result += caption[at++];
      continue;
    }
    const auto [length, other] = find_term(lower, at);
    const std::string_view term = std::string_view(caption).substr(at, length);
    const Letters letters = letters_of(term);
    const bool keep =
        length == 0 || letters == Letters::mixed ||
        ((other == "left" || other == "right") && means_departed(caption, at, at + length));
    if (!keep) {
      result += with_letters(other, letters);
      at += length;
      continue;
    }
    while (at < caption.size() && is_letter(caption[at])) result += caption[at++];
  }
  return result;
}

}  // namespace remomask::text
