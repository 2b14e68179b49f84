#pragma once

#include <functional>
#include <string>

namespace remomask::search {

/// What foreign_language() says of words that are in no language that it knows.
inline constexpr const char* kAnotherLanguage = "another language";

/// The language that a sentence seems to be in, "Spanish", if that is not English: by the script of
/// its letters, or by words that are frequent in descriptions of movement. "another language" for
/// at least two words of which `is_english` knows none. Empty: English, as far as can be told.
/// Typing errors, names and single borrowed words are English.
std::string foreign_language(const std::string& sentence,
                             const std::function<bool(const std::string&)>& is_english);

}  // namespace remomask::search
