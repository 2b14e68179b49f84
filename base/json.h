#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace remomask {

/// Maximum nesting that is read. Writing JSON recurses once per level, so that a hostile file
/// could overflow the stack; our own JSON is nested at most eight levels deep.
inline constexpr int kMaxJsonDepth = 100;

/// Parses JSON text. Throws nlohmann::json::exception for text that is not JSON or is nested deeper
/// than kMaxJsonDepth.
nlohmann::json parse_json(std::string_view text);

/// What such an exception says, without the name and number of the exception.
std::string json_reason(const nlohmann::json::exception& error);

/// The same, but a discarded value (is_discarded()) instead of an exception.
nlohmann::json try_parse_json(std::string_view text);

}  // namespace remomask
