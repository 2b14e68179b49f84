#pragma once

#include <string>
#include <vector>

#include "synthetic/procedural.h"

namespace remomask::synthetic {

enum class VerbForm { base, third_person, gerund };

/// "walk" -> "walks" / "walking". Regular English and the doubled consonants of
/// the verbs used here.
std::string inflect(const std::string& verb, VerbForm form);

/// Three or four different sentences. `phrases` are verb phrases with {verbs}
/// in braces and the slots [side], [n], [times]; `adverbs` follow the phrase.
std::vector<std::string> write_captions(const std::vector<std::string>& phrases,
                                        const std::string& side, int count,
                                        const std::vector<std::string>& adverbs,
                                        uint64_t variation);

}  // namespace remomask::synthetic
