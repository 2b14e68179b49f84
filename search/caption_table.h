#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "db/database.h"
#include "search/quantized_rows.h"

namespace remomask::search {

/// How near the captions of a clip are to a sentence.
struct CaptionMatch {
  float best = -1, mean = -1;
  int32_t caption = -1;  ///< of the table: the nearest; -1: the clip has none
};

/// The captions of all clips with their vectors, each text once. Compares a sentence with every one
/// of them, first roughly: that takes as long as reading a byte for each number of the vectors.
/// Those of the clips that can matter are compared again with all digits.
class CaptionTable {
 public:
  /// `texts_of(place)` gives the captions of each of the clips; those without a vector are left
  /// out.
  CaptionTable(size_t clips, const std::function<std::vector<std::string>(size_t)>& texts_of,
               const std::vector<db::CaptionVector>& vectors);

  /// Cosines of a vector [width] and every caption to within 0.003. Throws Error for another width.
  std::vector<float> rough_cosines(const std::vector<float>& query) const;
  /// What these mean for a clip.
  CaptionMatch rough_match(size_t clip, const std::vector<float>& rough) const {
    return match(clip, [&](int32_t row) { return rough[static_cast<size_t>(row)]; });
  }
  /// The same from the cosines themselves.
  CaptionMatch exact_match(size_t clip, const std::vector<float>& query) const;

  const std::string& text(int32_t caption) const { return texts_[static_cast<size_t>(caption)]; }
  /// named_sides() of a caption.
  unsigned sides(int32_t caption) const { return sides_[static_cast<size_t>(caption)]; }
  bool has_captions(size_t clip) const { return first_[clip] != first_[clip + 1]; }
  /// Whether a caption of the clip names a side.
  bool names_side(size_t clip) const;
  size_t size() const { return texts_.size(); }
  /// Clips with a caption that has no vector.
  int64_t incomplete_clips() const { return incomplete_clips_; }

 private:
  template <typename CosineOf>
  CaptionMatch match(size_t clip, CosineOf cosine_of) const;

  std::vector<std::string> texts_;
  std::vector<uint8_t> sides_;
  std::vector<float> vectors_;  // [texts][width]
  QuantizedRows rough_;         // of the same
  int64_t width_ = 0, incomplete_clips_ = 0;
  std::vector<size_t> first_;  // of each clip in rows_, and the end
  std::vector<int32_t> rows_;  // captions of the clips
};

template <typename CosineOf>
CaptionMatch CaptionTable::match(size_t clip, CosineOf cosine_of) const {
  CaptionMatch match;
  const size_t first = first_[clip], last = first_[clip + 1];
  double sum = 0;
  for (size_t i = first; i < last; ++i) {
    const float cosine = cosine_of(rows_[i]);
    sum += cosine;
    if (match.caption >= 0 && cosine <= match.best) continue;
    match.best = cosine;
    match.caption = rows_[i];
  }
  if (first != last) match.mean = static_cast<float>(sum / static_cast<double>(last - first));
  return match;
}

/// Sides that a text names: bit 0 left, bit 1 right.
unsigned named_sides(const std::string& text);

}  // namespace remomask::search
