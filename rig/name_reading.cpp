#include "rig/name_reading.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "rig/name_words.h"

namespace remomask::rig {

namespace {

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
/// A byte of a letter outside ASCII.
bool is_high(char c) { return static_cast<unsigned char>(c) >= 0x80; }

bool is_number(const std::string& word) { return !word.empty() && is_digit(word[0]); }

std::string translate(std::string name) {
  if (std::none_of(name.begin(), name.end(), is_high)) return name;
  for (const auto& [from, to] : east_asian_words()) {
    for (size_t at = name.find(from); at != std::string::npos; at = name.find(from, at)) {
      name.replace(at, from.size(), " " + to + " ");
      at += to.size() + 2;
    }
  }
  return name;
}

/// Splits at separators, where lower case meets upper case, and where letters meet digits.
std::vector<std::string> split_name(const std::string& name) {
  std::vector<std::string> words;
  std::string word;
  const auto finish = [&] {
    if (!word.empty()) words.push_back(word);
    word.clear();
  };
  for (size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (!is_upper(c) && !is_lower(c) && !is_digit(c) && !is_high(c)) {
      finish();
      continue;
    }
    if (!word.empty()) {
      const char before = name[i - 1];
      const bool last_capital = is_upper(c) && is_upper(before) && i + 1 < name.size() &&
                                is_lower(name[i + 1]);  // "LThigh" is L, Thigh
      if ((is_upper(c) && !is_upper(before)) || last_capital || is_digit(c) != is_digit(before)) {
        finish();
      }
    }
    word.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  }
  finish();
  return words;
}

/// Words of the dictionary that make up a word written together, as few as possible; the word
/// itself if it is no such compound. A single l or r counts at either end only.
std::vector<std::string> take_apart(const std::string& word) {
  if (is_number(word) || look_up_word(word).kind != WordKind::unknown || word.size() > 40) {
    return {word};
  }
  const size_t size = word.size();
  std::vector<int> pieces(size + 1, -1);
  std::vector<size_t> from(size + 1, 0);
  pieces[0] = 0;
  for (size_t end = 1; end <= size; ++end) {
    for (size_t begin = 0; begin < end; ++begin) {
      if (pieces[begin] < 0) continue;
      const std::string piece = word.substr(begin, end - begin);
      if (look_up_word(piece).kind == WordKind::unknown) continue;
      const bool side = piece == "l" || piece == "r";
      if (piece.size() < 2 && !(side && (begin == 0 || end == size))) continue;
      if (pieces[end] < 0 || pieces[begin] + 1 < pieces[end]) {
        pieces[end] = pieces[begin] + 1;
        from[end] = begin;
      }
    }
  }
  if (pieces[size] < 0) return {word};
  std::vector<std::string> parts;
  for (size_t end = size; end > 0; end = from[end]) {
    parts.insert(parts.begin(), word.substr(from[end], end - from[end]));
  }
  // "rl" is no joint on both sides.
  const bool sides = std::all_of(parts.begin(), parts.end(), [](const std::string& part) {
    return look_up_word(part).kind == WordKind::side;
  });
  if (sides) return {word};
  return parts;
}

/// "LUArm" and "LFArm" give "lu" and "lf": a side and the upper or fore part. (In "lf_arm", lf is
/// the side alone.)
void expand_initials(const std::string& name, std::vector<std::string>& words) {
  static const std::map<std::string, std::pair<std::string, std::string>> kInitials = {
      {"lu", {"left", "upper"}}, {"ru", {"right", "upper"}}, {"lf", {"left", "fore"}},
      {"rf", {"right", "fore"}}, {"ll", {"left", "lower"}},  {"rl", {"right", "lower"}}};
  for (size_t i = 0; i + 1 < words.size(); ++i) {
    const auto found = kInitials.find(words[i]);
    if (found == kInitials.end() || (words[i + 1] != "arm" && words[i + 1] != "leg")) continue;
    std::string together = words[i] + words[i + 1];
    for (size_t c = 0; c < 3; ++c) together[c] = static_cast<char>(together[c] - 'a' + 'A');
    if (name.find(together) == std::string::npos) continue;
    words[i] = found->second.second;
    words.insert(words.begin() + static_cast<long>(i), found->second.first);
  }
}

/// "L5", "T12", "C7" number the vertebrae from the loins to the neck.
BodyPart vertebra(const std::vector<std::string>& words) {
  if (words.size() != 2 || !is_number(words[1]) || words[1].size() > 2) return BodyPart::none;
  if (words[0] == "c") return BodyPart::neck;
  if (words[0] == "l" || words[0] == "t") return BodyPart::spine;
  return BodyPart::none;
}

/// What the words for body parts mean together.
BodyPart join_parts(const std::set<BodyPart>& parts, const std::set<WordKind>& kinds, Side side) {
  const auto has = [&](BodyPart part) { return parts.count(part) > 0; };
  const bool upper = kinds.count(WordKind::upper) > 0, lower = kinds.count(WordKind::lower) > 0,
             fore = kinds.count(WordKind::fore) > 0;
  if (side == Side::none) {
    // "SpineShoulder" and "ShoulderCenter" are points of the spine, "HipCenter" is the pelvis.
    if (has(BodyPart::neck)) return BodyPart::neck;
    if (has(BodyPart::spine)) {
      return has(BodyPart::hip) || has(BodyPart::pelvis) ? BodyPart::pelvis : BodyPart::spine;
    }
    if (has(BodyPart::pelvis) || has(BodyPart::hip)) return BodyPart::pelvis;
    if (has(BodyPart::shoulder) && has(BodyPart::root)) return BodyPart::spine;
    if (has(BodyPart::head)) return BodyPart::head;
    if (has(BodyPart::root)) return BodyPart::root;
    return BodyPart::none;
  }
  if (has(BodyPart::toe) || (fore && has(BodyPart::foot))) return BodyPart::toe;
  for (const BodyPart part :
       {BodyPart::ankle, BodyPart::heel, BodyPart::foot, BodyPart::shin, BodyPart::thigh}) {
    if (has(part)) return part;
  }
  if (has(BodyPart::leg)) {
    return lower ? BodyPart::shin : upper ? BodyPart::thigh : BodyPart::leg;
  }
  for (const BodyPart part :
       {BodyPart::wrist, BodyPart::hand, BodyPart::forearm, BodyPart::upper_arm}) {
    if (has(part)) return part;
  }
  if (has(BodyPart::arm)) {
    return lower || fore ? BodyPart::forearm : upper ? BodyPart::upper_arm : BodyPart::arm;
  }
  if (has(BodyPart::collar)) return BodyPart::collar;
  if (has(BodyPart::shoulder)) return BodyPart::shoulder;
  if (has(BodyPart::hip) || has(BodyPart::pelvis)) return BodyPart::hip;
  return BodyPart::none;
}

NameReading read_words(const std::vector<std::string>& words,
                       const std::map<std::string, size_t>& use, size_t joints) {
  NameReading reading;
  if (const BodyPart part = vertebra(words); part != BodyPart::none) {
    reading.part = part;
    reading.number = std::stoi(words[1]);
    return reading;
  }
  std::set<BodyPart> parts;
  std::set<WordKind> kinds;
  bool hip_joint = false;
  for (size_t i = 0; i < words.size(); ++i) {
    if (is_number(words[i])) {
      if (!parts.empty() && words[i].size() < 6) reading.number = std::stoi(words[i]);
      continue;
    }
    const Word word = look_up_word(words[i]);
    kinds.insert(word.kind);
    if (word.kind == WordKind::part) parts.insert(word.part);
    if (word.kind == WordKind::side && reading.side == Side::none) reading.side = word.side;
    if (word.kind == WordKind::unknown && use.at(words[i]) * 5 < joints * 2) {
      ++reading.strange_words;
    }
    hip_joint |= words[i] == "joint" && i > 0 && words[i - 1] == "hip";
  }
  reading.helper = kinds.count(WordKind::helper) > 0;
  // The middle of the spine, or a finger of a hand.
  if (reading.side == Side::none && parts.count(BodyPart::spine) > 0 &&
      std::find(words.begin(), words.end(), "middle") != words.end()) {
    reading.helper = false;
  }
  reading.tail = kinds.count(WordKind::tail) > 0;
  reading.end = kinds.count(WordKind::end) > 0;
  reading.part = join_parts(parts, kinds, reading.side);
  if (reading.side != Side::none) {
    reading.connector =
        kinds.count(WordKind::connector) > 0 || hip_joint || parts.count(BodyPart::pelvis) > 0;
    if (reading.part == BodyPart::none && reading.connector) reading.part = BodyPart::hip;
  }
  if (reading.tail) reading.part = BodyPart::none;
  return reading;
}

/// Rigify keeps the bones that deform the body among copies of them: where a set of bones is
/// marked, the others are helpers.
void keep_marked_set(const std::vector<std::vector<std::string>>& words,
                     std::vector<NameReading>& readings) {
  for (const char* mark : {"def", "org"}) {
    const auto marked = [&](const std::vector<std::string>& name) {
      return !name.empty() && name[0] == mark;
    };
    if (std::count_if(words.begin(), words.end(), marked) < 12) continue;
    for (size_t j = 0; j < words.size(); ++j) readings[j].helper |= !marked(words[j]);
    return;
  }
}

}  // namespace

std::vector<std::string> words_of_name(std::string_view name) {
  const size_t space = name.find_last_of(":|");
  if (space != std::string_view::npos && space + 1 < name.size()) name.remove_prefix(space + 1);
  std::vector<std::string> words;
  for (const std::string& word : split_name(translate(std::string(name)))) {
    for (std::string& part : take_apart(word)) words.push_back(std::move(part));
  }
  expand_initials(std::string(name), words);
  return words;
}

std::vector<NameReading> read_joint_names(const std::vector<std::string>& names) {
  std::vector<std::vector<std::string>> words;
  std::map<std::string, size_t> use;
  for (const std::string& name : names) {
    words.push_back(words_of_name(name));
    for (const std::string& word : std::set<std::string>(words.back().begin(), words.back().end()))
      ++use[word];
  }
  std::vector<NameReading> readings;
  for (const auto& name : words) readings.push_back(read_words(name, use, names.size()));
  keep_marked_set(words, readings);
  return readings;
}

}  // namespace remomask::rig
