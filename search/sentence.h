#pragma once

#include <string>
#include <vector>

namespace remomask::search {

/// A sentence as people type it into a search box.
struct Sentence {
  std::string text;                   ///< what is wanted; may be empty
  std::vector<std::string> unwanted;  ///< words that stood behind a minus
};

/// "walk -backward" -> {"walk", {"backward"}}. A minus is a negation where it
/// begins a word and a letter follows: not inside a word ("left-handed"), not
/// before a number ("-90 degrees"), not alone or doubled ("a - b", "--").
Sentence parse_sentence(const std::string& sentence);

}  // namespace remomask::search
