#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace remomask {

/// Deepest nesting that is read. Writing JSON recurses once a level, so that a file from a stranger
/// could overflow the stack; nothing of ours is nested deeper than eight levels.
inline constexpr int kMaxJsonDepth = 100;

/// Parses JSON text. Throws nlohmann::json::exception for text that is no JSON or is nested deeper
/// than kMaxJsonDepth.
nlohmann::json parse_json(std::string_view text);

/// What such an exception says, without the name and number of the exception.
std::string json_reason(const nlohmann::json::exception& error);

/// The same, but a discarded value (is_discarded()) instead of an exception.
nlohmann::json try_parse_json(std::string_view text);

}  // namespace remomask
