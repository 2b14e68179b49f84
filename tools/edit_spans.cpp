#include "tools/edit_spans.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>

#include "remomask/error.h"

namespace remomask::tools {

namespace {

constexpr double kEditFps = 20;

std::vector<std::string> split_list(const std::string& text, char separator) {
  std::vector<std::string> items;
  size_t begin = 0;
  for (size_t end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find(separator, begin);
    items.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return items;
}

int parse_time(std::string_view text, const std::string& span, int frames) {
  if (text == "start") return 0;
  if (text == "end") return frames;
  double seconds = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(seconds)) {
    throw Error(
        fmt::format("span \"{}\": \"{}\" is not a time; write seconds, start or end, for "
                    "example 1.5-3 or 2-end",
                    span, text));
  }
  if (seconds * kEditFps > 1e8) throw Error(fmt::format("span \"{}\" is too far away", span));
  return static_cast<int>(std::lround(seconds * kEditFps));
}

EditSpan parse_span(const std::string& text, int frames) {
  const size_t dash = text.find('-', 1);
  if (dash == std::string::npos) {
    throw Error(fmt::format("span \"{}\" has no end; write BEGIN-END in seconds", text));
  }
  EditSpan span;
  span.first = parse_time(std::string_view(text).substr(0, dash), text, frames);
  span.last = parse_time(std::string_view(text).substr(dash + 1), text, frames);
  if (span.first < 0 || span.last > frames || span.first >= span.last) {
    throw Error(
        fmt::format("span \"{}\" is empty or outside of the motion, which lasts 0 to {:g} s", text,
                    frames / kEditFps));
  }
  return span;
}

void add_spans(const std::string& text, const std::vector<std::string>& parts, int frames,
               std::vector<EditSpan>& result) {
  for (const std::string& item : split_list(text, ',')) {
    result.push_back(parse_span(item, frames));
    result.back().parts = parts;
  }
}

}  // namespace

std::vector<EditSpan> parse_edit_spans(const std::string& spans,
                                       const std::vector<std::string>& parts,
                                       const std::vector<std::string>& cells, int frames) {
  std::vector<EditSpan> result;
  if (!spans.empty()) {
    add_spans(spans, parts, frames, result);
  } else if (!parts.empty()) {
    result.push_back({0, frames, parts});
  }
  for (const std::string& cell : cells) {
    const size_t colon = cell.find(':');
    const std::vector<std::string> named = colon == std::string::npos
                                               ? std::vector<std::string>()
                                               : split_list(cell.substr(colon + 1), ',');
    add_spans(cell.substr(0, colon), named, frames, result);
  }
  return result;
}

}  // namespace remomask::tools
