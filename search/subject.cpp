#include "search/subject.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <unordered_set>
#include <vector>

#include "search/lower_case.h"

namespace remomask::search {

namespace {

bool is_article(const std::string& word) {
  static const std::unordered_set<std::string> words = {"a",    "an",  "the", "this", "that",
                                                        "some", "one", "my",  "our",  "your"};
  return words.contains(word);
}

bool is_mover(const std::string& word) {
  static const std::unordered_set<std::string> words = {
      "he",     "she",       "it",     "someone", "somebody",  "person",
      "man",    "woman",     "guy",    "girl",    "boy",       "kid",
      "child",  "dude",      "bro",    "lady",    "gentleman", "human",
      "figure", "character", "player", "robot",   "subject",   "participant",
      "actor",  "avatar",    "npc",    "hero",    "fellow",    "individual"};
  return words.contains(word);
}

/// "walks", "is", "doesn't", but not "pass" as a noun or "his".
bool is_third_person(const std::string& word) {
  if (word == "is" || word == "has" || word == "does") return true;
  return word.size() > 3 && word.back() == 's' && !word.ends_with("ss");
}

}  // namespace

std::string generic_subject(const std::string& sentence) {
  std::istringstream stream(sentence);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  size_t mover = 0;
  if (!words.empty() && is_article(lower_case(words[0]))) mover = 1;
  if (mover + 1 >= words.size() || !is_mover(lower_case(words[mover])) ||
      !is_third_person(lower_case(words[mover + 1]))) {
    return sentence;
  }
  std::string generic = "a person";
  for (size_t i = mover + 1; i < words.size(); ++i) generic += " " + words[i];
  return generic;
}

}  // namespace remomask::search
