#pragma once

#include <cctype>
#include <string>

namespace remomask::search {

/// A word in lower case; letters beyond ASCII stay as they are.
inline std::string lower_case(std::string word) {
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return word;
}

}  // namespace remomask::search
