#include "text/words.h"

namespace remomask::text {

namespace {

bool is_word_break(char c) {
  const auto u = static_cast<unsigned char>(c);
  return u < 0x80 && !(c >= 'a' && c <= 'z') && !(c >= '0' && c <= '9') && !(c >= 'A' && c <= 'Z');
}

}  // namespace

std::vector<std::string> split_words(const std::string& caption) {
  std::vector<std::string> words;
  std::string word;
  const auto finish = [&] {
    if (!word.empty()) words.push_back(word);
    word.clear();
  };
  for (const char c : caption) {
    if (is_word_break(c)) {
      finish();
      if (c != ' ') words.emplace_back(1, c);
    } else {
      word += c;
    }
  }
  finish();
  return words;
}

}  // namespace remomask::text
