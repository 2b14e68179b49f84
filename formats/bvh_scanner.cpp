#include "formats/bvh_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/decimal.h"
#include "remomask/error.h"
#include "text/encoding.h"

namespace remomask::formats {

namespace {

constexpr size_t kMaxShownBytes = 60;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; }

bool is_letter(char c) { return lower(c) >= 'a' && lower(c) <= 'z'; }

}  // namespace

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

std::string shown_text(std::string_view text) {
  const bool whole = text.size() <= kMaxShownBytes;
  size_t length = std::min(text.size(), kMaxShownBytes);
  while (!whole && length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) {
    --length;  // not inside of a character
  }
  std::string shown(text.substr(0, length));
  const bool readable = text::is_utf8(shown);
  for (char& c : shown) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 32 || byte == 127 || (byte > 127 && !readable)) c = '?';
  }
  return whole ? shown : shown + "...";
}

std::string in_quotes(std::string_view text) { return '"' + shown_text(text) + '"'; }

std::string about_decimal_comma(std::string_view word) {
  const size_t comma = word.find(',');
  if (comma == std::string_view::npos || comma + 1 == word.size()) return "";
  return "; numbers have a decimal point, not a decimal comma";
}

void BvhScanner::fail(const std::string& message) const { throw FileError(path_, line_, message); }

void BvhScanner::warn(long line, const std::string& message) {
  warnings_.emplace_back(FileError(path_, line, message).what());
}

std::string_view BvhScanner::next_word() {
  skip_blank_lines();
  const char* start = p_;
  if (p_ < end_ && (*p_ == '{' || *p_ == '}')) {
    ++p_;
  } else {
    while (p_ < end_ && !is_bvh_blank(*p_) && !is_line_end(*p_) && *p_ != '{' && *p_ != '}') ++p_;
  }
  return {start, static_cast<size_t>(p_ - start)};
}

std::string_view BvhScanner::rest_of_line() {
  while (p_ < end_ && is_bvh_blank(*p_)) ++p_;
  const char* start = p_;
  while (p_ < end_ && !is_line_end(*p_) && *p_ != '{') ++p_;
  const char* last = p_;
  while (last > start && is_bvh_blank(last[-1])) --last;
  return {start, static_cast<size_t>(last - start)};
}

std::string BvhScanner::header_label() {
  skip_blank_lines();
  std::string label;
  for (; p_ < end_ && (is_letter(*p_) || is_bvh_blank(*p_)); ++p_) {
    if (is_letter(*p_)) label += lower(*p_);
  }
  if (p_ < end_ && *p_ == ':') ++p_;
  return label;
}

void BvhScanner::expect(std::string_view wanted, std::string_view where) {
  const std::string_view word = next_word();
  if (same_word(word, wanted)) return;
  if (word.empty()) {
    fail(
        fmt::format("the file ends where \"{}\" was expected ({}); it is truncated, export it "
                    "again",
                    wanted, where));
  }
  fail(fmt::format("expected \"{}\" {}, found {}", wanted, where, in_quotes(word)));
}

double BvhScanner::read_number(const char* what) {
  const std::string_view word = next_word();
  double value = 0;
  if (word.empty()) fail(fmt::format("the file ends inside {}; it is truncated", what));
  if (parse_number(word.data(), word.data() + word.size(), value) != word.data() + word.size()) {
    fail(fmt::format("{} needs a number, found {}{}", what, in_quotes(word),
                     about_decimal_comma(word)));
  }
  if (!(std::abs(value) <= kMaxBvhValue)) {
    fail(fmt::format("{} holds {}, which is not a plausible size", what, shown_text(word)));
  }
  return value;
}

}  // namespace remomask::formats
