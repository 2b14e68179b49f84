#pragma once

#include <string>

namespace remomask::text {

/// The caption of the mirrored motion: whole words left/right,
/// clockwise/counterclockwise (anticlockwise), leftward(s)/rightward(s),
/// left-handed/right-handed and so on are exchanged, capitals kept. "left" as
/// the past tense of "leave" stays. Twice is the identity.
std::string mirror_caption(const std::string& caption);

}  // namespace remomask::text
