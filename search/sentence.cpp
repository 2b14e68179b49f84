#include "search/sentence.h"

#include <cctype>
#include <sstream>

namespace remomask::search {

namespace {

bool is_letter(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x80 || std::isalpha(byte) != 0;  // any letter beyond ASCII as well
}

bool is_negation(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && is_letter(word[1]);
}

}  // namespace

Sentence parse_sentence(const std::string& sentence) {
  Sentence result;
  std::istringstream words(sentence);
  for (std::string word; words >> word;) {
    if (!is_negation(word)) {
      result.text += (result.text.empty() ? "" : " ") + word;
      continue;
    }
    word.erase(0, 1);
    // A comma belongs to the sentence; the first character is a letter.
    while (std::ispunct(static_cast<unsigned char>(word.back())) != 0) word.pop_back();
    result.unwanted.push_back(word);
  }
  return result;
}

}  // namespace remomask::search
