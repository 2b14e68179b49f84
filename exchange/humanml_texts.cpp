#include "exchange/humanml_texts.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/file.h"
#include "remomask/error.h"

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
    throw FileError(path, line, "'" + std::string(text) + "' is not a time in seconds");
  }
  return std::isnan(value) ? 0 : value;
}

}  // namespace

std::vector<TimedCaptions> read_humanml_texts(const std::string& path) {
  const std::string content = read_file(path);
  std::vector<TimedCaptions> parts;
  std::string_view rest = content;
  for (long line = 1; !rest.empty(); ++line) {
    const size_t end = rest.find('\n');
    const std::string_view text = trimmed(rest.substr(0, end));
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    if (text.empty()) continue;
    std::vector<std::string_view> fields;
    for (size_t begin = 0; begin <= text.size();) {
      const size_t stop = std::min(text.find('#', begin), text.size());
      fields.push_back(trimmed(text.substr(begin, stop - begin)));
      begin = stop + 1;
    }
    if (fields.size() < 4 || fields[0].empty()) {
      throw FileError(path, line, "is not of the form caption#tokens#from#to");
    }
    const double from = parse_time_tag(fields[2], path, line);
    const double to = parse_time_tag(fields[3], path, line);
    if (to <= from && (from != 0 || to != 0)) {
      throw FileError(path, line, "the part ends before it begins");
    }
    auto part = std::find_if(parts.begin(), parts.end(), [&](const TimedCaptions& other) {
      return other.from == from && other.to == to;
    });
    if (part == parts.end()) part = parts.insert(parts.end(), {from, to, {}});
    part->captions.emplace_back(fields[0]);
  }
  return parts;
}

}  // namespace remomask::exchange
