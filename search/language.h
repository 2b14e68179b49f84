#pragma once

#include <functional>
#include <string>

namespace remomask::search {

/// What foreign_language() says of words that are in no language that it knows.
inline constexpr const char* kAnotherLanguage = "another language";

/// What is known of English words.
struct KnownWords {
  std::function<bool(const std::string&)> in_captions;  ///< a caption of the database has it
  std::function<bool(const std::string&)> is_word;      ///< it is one at all, here or elsewhere
};

/// The language that a sentence seems to be in, "Spanish", if that is not English: by the script of
/// its letters, or by words that are frequent in descriptions of movement and more than those of
/// English. "another language" for at least two words of which none is known. Empty: English, as
/// far as can be told. Names and single borrowed words are English.
std::string foreign_language(const std::string& sentence, const KnownWords& known);

}  // namespace remomask::search
