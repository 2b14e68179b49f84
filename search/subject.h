#pragma once

#include <string>

namespace remomask::search {

/// "The girl waves", "he waves" and "robot waves" -> "a person waves": who moves changes nothing
/// about a motion, but much about what a sentence encoder makes of a short sentence. Only at the
/// beginning, and only before a verb in the third person, so that "robot dance" stays.
std::string generic_subject(const std::string& sentence);

}  // namespace remomask::search
