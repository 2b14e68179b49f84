#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace remomask::text {

/// Code points of a UTF-8 text; bytes that are no valid UTF-8 are left out.
std::vector<char32_t> decode_utf8(std::string_view text);

void append_utf8(std::string& text, char32_t code_point);

}  // namespace remomask::text
