#pragma once

#include <string>
#include <vector>

namespace remomask::text {

/// Words and single punctuation characters of a normalised caption.
std::vector<std::string> split_words(const std::string& caption);

}  // namespace remomask::text
