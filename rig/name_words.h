#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rig/name_reading.h"

namespace remomask::rig {

/// What one word of a joint's name contributes.
enum class WordKind {
  unknown,
  filler,
  side,
  part,
  upper,
  lower,
  fore,
  helper,
  end,
  connector,
  tail
};

struct Word {
  WordKind kind = WordKind::unknown;
  BodyPart part = BodyPart::none;
  Side side = Side::none;
};

/// Looks up a lower-case word.
Word look_up_word(std::string_view word);

/// Japanese and Chinese names of body parts in English, longer ones first.
const std::vector<std::pair<std::string, std::string>>& east_asian_words();

}  // namespace remomask::rig
