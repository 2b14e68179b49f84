#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace remomask::text {

/// Longest caption that is read, in bytes; the rest of a longer one is ignored.
inline constexpr size_t kMostCaptionBytes = 8192;

/// The canonical form that equality of captions and the tokenizer work on:
/// lower case (ASCII, Latin, Greek, Cyrillic), typographic punctuation and
/// whitespace as ASCII, one space between words, whole numbers 0 to 20 as
/// words, no . ! ? , ; : at the end, invalid UTF-8 left out. Idempotent. May be
/// empty.
std::string normalise_caption(std::string_view caption);

/// The same for a text that a user gave: throws Error when nothing is left.
std::string normalise_prompt(std::string_view text);

}  // namespace remomask::text
