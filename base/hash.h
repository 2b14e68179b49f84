#pragma once

#include <string>
#include <string_view>

namespace remomask {

/// 128-bit XXH3 of `content` as 32 hexadecimal digits: identity of clips and
/// models (not a protection against forgery).
std::string content_hash(std::string_view content);

}  // namespace remomask
