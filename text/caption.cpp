#include "text/caption.h"

#include <array>
#include <vector>

#include "remomask/error.h"
#include "text/utf8.h"

namespace remomask::text {

namespace {

bool is_blank(char32_t c) {
  return c <= 0x20 || c == 0x7F || (c >= 0x80 && c <= 0xA0) || c == 0x1680 ||
         (c >= 0x2000 && c <= 0x200A) || c == 0x2028 || c == 0x2029 || c == 0x202F || c == 0x205F ||
         c == 0x3000;
}

/// Soft hyphen, zero-width and direction marks, combining variation selectors.
bool is_invisible(char32_t c) {
  return c == 0xAD || (c >= 0x200B && c <= 0x200F) || (c >= 0x202A && c <= 0x202E) ||
         (c >= 0x2060 && c <= 0x2064) || (c >= 0xFE00 && c <= 0xFE0F) || c == 0xFEFF;
}

char32_t lower_case(char32_t c) {
  if ((c >= 'A' && c <= 'Z') || (c >= 0xC0 && c <= 0xDE && c != 0xD7)) return c + 0x20;
  if ((c >= 0x391 && c <= 0x3A9 && c != 0x3A2) || (c >= 0x410 && c <= 0x42F)) return c + 0x20;
  if (c >= 0x400 && c <= 0x40F) return c + 0x50;
  if (c >= 0x100 && c <= 0x137 && c != 0x130 && c != 0x131) return c | 1;
  if (c >= 0xFF01 && c <= 0xFF5E) return lower_case(c - 0xFEE0);  // full-width forms
  return c;
}

void append_canonical(std::string& text, char32_t c) {
  switch (c) {
    case 0x2018:
    case 0x2019:
    case 0x201A:
    case 0x201B:
    case 0x2032:
    case 0xB4:
    case 0x60:
      text += '\'';
      return;
    case 0x201C:
    case 0x201D:
    case 0x201E:
    case 0x201F:
    case 0x2033:
    case 0xAB:
    case 0xBB:
      text += '"';
      return;
    case 0x2010:
    case 0x2011:
    case 0x2012:
    case 0x2013:
    case 0x2014:
    case 0x2015:
    case 0x2212:
      text += '-';
      return;
    case 0x2026:
      text += "...";
      return;
    case 0x3001:
    case 0xFF64:
      text += ',';
      return;
    case 0x3002:
    case 0xFF61:
      text += '.';
      return;
    default:
      append_utf8(text, lower_case(c));
  }
}

constexpr std::array<const char*, 21> kNumberWords = {
    "zero",     "one",     "two",     "three",     "four",     "five",     "six",
    "seven",    "eight",   "nine",    "ten",       "eleven",   "twelve",   "thirteen",
    "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen", "twenty"};

/// "4" -> "four", also before punctuation ("4,"); "3.5", "180" and "2nd" stay.
std::string number_as_word(const std::string& word) {
  size_t digits = 0;
  while (digits < word.size() && word[digits] >= '0' && word[digits] <= '9') ++digits;
  if (digits == 0 || digits > 2) return word;
  for (size_t i = digits; i < word.size(); ++i) {
    const auto c = static_cast<unsigned char>(word[i]);
    if (c >= 0x80 || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) return word;
  }
  const size_t value = std::stoul(word.substr(0, digits));
  return value < kNumberWords.size() ? kNumberWords[value] + word.substr(digits) : word;
}

}  // namespace

std::string normalise_caption(std::string_view caption) {
  std::string words, word;
  const auto finish_word = [&] {
    if (word.empty()) return;
    if (!words.empty()) words += ' ';
    words += number_as_word(word);
    word.clear();
  };
  for (const char32_t c : decode_utf8(caption.substr(0, kMostCaptionBytes))) {
    if (is_blank(c)) {
      finish_word();
    } else if (!is_invisible(c)) {
      append_canonical(word, c);
    }
  }
  finish_word();
  // Networks that were trained on captions without them are thrown off by "!" and "?".
  words.erase(words.find_last_not_of(" .!?,;:") + 1);
  return words;
}

std::string normalise_prompt(std::string_view text) {
  std::string words = normalise_caption(text);
  if (words.empty()) {
    throw Error(
        "the text is empty; describe the motion in words, for example "
        "\"a person walks forward and sits down\"");
  }
  return words;
}

}  // namespace remomask::text
