#pragma once

#include <memory>
#include <optional>
#include <string>

#include "encoders/sentence_encoder.h"
#include "search/word_score.h"

namespace remomask::search {

/// What to make of a score that cannot be read.
enum class DamagedScore { is_refused, is_none };

/// What a text file holds for search: the sentence encoder, and the score that was fitted to it.
struct WordModel {
  std::shared_ptr<const encoders::SentenceEncoder> encoder;
  std::optional<WordScore> score;  ///< none: hits have no probability and cannot be fused

  /// Throws FileError as SentenceEncoder::open() does, and for a score that is damaged, unless that
  /// is to be replaced.
  static WordModel open(const std::string& path, DamagedScore damaged = DamagedScore::is_refused);
};

/// Puts the score into a text file in place of the one that it has.
void store_word_score(const std::string& path, const WordScore& score);

}  // namespace remomask::search
