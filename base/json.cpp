#include "base/json.h"

#include <string>

namespace remomask {

namespace {

constexpr size_t kMaxReason = 160;
/// A value takes up to 100 bytes of memory, whatever the two that it may have in the file.
constexpr int64_t kMaxValues = 2'000'000;

/// Why a text is not parsed, or null. Looks only at brackets and commas outside of strings, which
/// are all that decides depth and number of values of valid JSON.
const char* excess_of(std::string_view text) {
  int depth = 0;
  int64_t values = 0;
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{' || c == ',') {
      if (++values > kMaxValues) return "it holds more than two million values";
      if (c != ',' && ++depth > kMaxJsonDepth) return "it is nested deeper than 100 levels";
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return nullptr;
}
static_assert(kMaxJsonDepth == 100, "the message says 100");

}  // namespace

nlohmann::json parse_json(std::string_view text) {
  if (const char* excess = excess_of(text)) {
    throw nlohmann::json::other_error::create(501, excess, nullptr);
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
  if (excess_of(text) != nullptr) return nlohmann::json(nlohmann::json::value_t::discarded);
  return nlohmann::json::parse(text, nullptr, false);
}

}  // namespace remomask
