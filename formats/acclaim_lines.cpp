#include "formats/acclaim_lines.h"

#include <fmt/format.h>

#include <cmath>

#include "formats/bvh_scanner.h"
#include "formats/decimal.h"
#include "remomask/error.h"

namespace remomask::formats {

namespace {

constexpr double kMaxAcclaimValue = 1e9;

}  // namespace

bool AcclaimLines::next() {
  if (again_) {
    again_ = false;
    return true;
  }
  while (!rest_.empty()) {
    const size_t end = rest_.find_first_of("\r\n");
    std::string_view text = rest_.substr(0, end);
    const bool two = end != rest_.npos && rest_.substr(end, 2) == "\r\n";
    rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + (two ? 2 : 1));
    ++line_;
    text = text.substr(0, text.find('#'));
    words_.clear();
    while (true) {
      const size_t first = text.find_first_not_of(" \t\f\v");
      if (first == text.npos) break;
      text.remove_prefix(first);
      words_.push_back(text.substr(0, text.find_first_of(" \t\f\v")));
      text.remove_prefix(words_.back().size());
    }
    if (!words_.empty()) return true;
  }
  return false;
}

double AcclaimLines::number(size_t place, std::string_view what) const {
  if (place >= words_.size()) {
    fail(fmt::format("{} has {} values, more are needed", what, words_.size() - 1));
  }
  const std::string_view word = words_[place];
  double value = 0;
  const char* end = word.data() + word.size();
  if (parse_number(word.data(), end, value) != end || !(std::abs(value) <= kMaxAcclaimValue)) {
    fail(fmt::format("{} needs a finite number, found {}", what, in_quotes(word)));
  }
  return value;
}

void AcclaimLines::fail(const std::string& message) const {
  throw FileError(path_, line_, message);
}

}  // namespace remomask::formats
