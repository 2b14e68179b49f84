#pragma once

#include <string>

namespace remomask::db {

/// The query for Database::match_captions() that finds captions with all words
/// of `text`, in any order: every word is quoted, so that nothing in it is read as
/// an operator. Empty if `text` has no letter or digit.
std::string quote_caption_words(const std::string& text);

}  // namespace remomask::db
