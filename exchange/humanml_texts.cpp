#include "exchange/humanml_texts.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "remomask/error.h"
#include "text/encoding.h"

namespace remomask::exchange {

namespace {

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// A time in seconds; the data sets write "nan" for "not given".
double parse_time_tag(std::string_view text, const std::string& path, long line) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || value < 0 || value > 1e6) {
    throw FileError(path, line,
                    "'" + std::string(text) + "' is not a time in seconds; write it like 2.5");
  }
  return std::isnan(value) ? 0 : value;
}

/// "walk/VERB", or "#/SYM" for the character itself.
bool is_tagged_word(std::string_view word) {
  const size_t slash = word.rfind('/');
  if (slash == std::string_view::npos || slash == 0 || slash + 1 == word.size()) return false;
  if (word.find('#', 1) != std::string_view::npos) return false;
  return std::all_of(word.begin() + static_cast<long>(slash) + 1, word.end(),
                     [](char c) { return c >= 'A' && c <= 'Z'; });
}

bool are_tokens(std::string_view text) {
  bool any = false;
  for (text = trimmed(text); !text.empty(); text = trimmed(text), any = true) {
    const std::string_view word = text.substr(0, text.find(' '));
    if (!is_tagged_word(word)) return false;
    text.remove_prefix(word.size());
  }
  return any;
}

/// What stands before the tokens. Both may hold a "#": tokens are words with tags, so they begin
/// behind the first "#" that only such words follow, otherwise behind the last.
std::string_view without_tokens(std::string_view text) {
  for (size_t at = text.find('#'); at != std::string_view::npos; at = text.find('#', at + 1)) {
    if (are_tokens(text.substr(at + 1))) return trimmed(text.substr(0, at));
  }
  return trimmed(text.substr(0, text.rfind('#')));
}

struct HumanmlLine {
  std::string_view caption;
  double from = 0, to = 0;
};

HumanmlLine parse_humanml_line(std::string_view text, const std::string& path, long line) {
  std::string_view rest = text, times[2];
  for (std::string_view& time : times) {
    const size_t at = rest.rfind('#');
    if (at == std::string_view::npos) {
      throw FileError(path, line, "is not of the form caption#tokens#from#to");
    }
    time = trimmed(rest.substr(at + 1));
    rest = rest.substr(0, at);
  }
  HumanmlLine result;
  if (rest.find('#') != std::string_view::npos) result.caption = without_tokens(rest);
  if (result.caption.empty()) {
    throw FileError(path, line, "is not of the form caption#tokens#from#to");
  }
  result.from = parse_time_tag(times[1], path, line);
  result.to = parse_time_tag(times[0], path, line);
  if (result.to <= result.from && (result.from != 0 || result.to != 0)) {
    throw FileError(path, line, "the part ends before it begins");
  }
  return result;
}

}  // namespace

std::vector<TimedCaptions> read_humanml_texts(const std::string& path,
                                              std::vector<std::string>& warnings) {
  const std::string content = text::read_lines_file(path);
  std::vector<TimedCaptions> parts;
  std::vector<std::string> bad_lines;
  std::optional<FileError> first_failure;
  std::string_view rest = content;
  for (long number = 1; !rest.empty(); ++number) {
    const size_t end = rest.find('\n');
    const std::string_view text = trimmed(rest.substr(0, end));
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    if (text.empty()) continue;
    try {
      const HumanmlLine line = parse_humanml_line(text, path, number);
      auto part = std::find_if(parts.begin(), parts.end(), [&](const TimedCaptions& other) {
        return other.from == line.from && other.to == line.to;
      });
      if (part == parts.end()) part = parts.insert(parts.end(), {line.from, line.to, {}});
      part->captions.emplace_back(line.caption);
    } catch (const FileError& error) {
      if (!first_failure) first_failure.emplace(error);
      bad_lines.push_back(std::string(error.what()) + ". The line is left out");
    }
  }
  if (parts.empty() && first_failure) throw FileError(*first_failure);
  warnings.insert(warnings.end(), bad_lines.begin(), bad_lines.end());
  return parts;
}

}  // namespace remomask::exchange
