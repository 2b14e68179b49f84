#include "base/json.h"

#include <string>

namespace remomask {

namespace {

constexpr size_t kMaxReason = 160;

/// Looks only at brackets outside of strings, which is all that decides the depth of valid JSON.
bool is_too_deep(std::string_view text) {
  int depth = 0;
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kMaxJsonDepth) return true;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return false;
}

}  // namespace

nlohmann::json parse_json(std::string_view text) {
  if (is_too_deep(text)) {
    throw nlohmann::json::other_error::create(
        501, "it is nested deeper than " + std::to_string(kMaxJsonDepth) + " levels", nullptr);
  }
  return nlohmann::json::parse(text);
}

std::string json_reason(const nlohmann::json::exception& error) {
  const std::string text = error.what();
  const size_t end = text.find("] ");
  const std::string reason =
      text.starts_with('[') && end != std::string::npos ? text.substr(end + 2) : text;
  // A parser quotes what it has read, which can be a whole vocabulary.
  return reason.size() <= kMaxReason ? reason : reason.substr(0, kMaxReason) + "...";
}

nlohmann::json try_parse_json(std::string_view text) {
  if (is_too_deep(text)) return nlohmann::json(nlohmann::json::value_t::discarded);
  return nlohmann::json::parse(text, nullptr, false);
}

}  // namespace remomask
