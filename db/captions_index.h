#pragma once

#include <string>

namespace remomask::db {

/// The query for Database::match_captions() that finds captions with all words
/// of `text`, in any order: every word is quoted, so that nothing in it is taken
/// for an operator. Empty when there is no letter or digit in it.
std::string quote_caption_words(const std::string& text);

}  // namespace remomask::db
