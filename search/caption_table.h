#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "db/database.h"

namespace remomask::search {

/// How near the captions of a clip are to a sentence.
struct CaptionMatch {
  float best = -1, mean = -1;
  int32_t caption = -1;  ///< of the table: the nearest; -1: the clip has none
};

/// The captions of all clips with their vectors, each text once. Compares a sentence with every
/// one of them: the cost is one product of a matrix [texts][width] and a vector.
class CaptionTable {
 public:
  /// `clips` as Database::clips() gives them; captions without a vector are left out.
  CaptionTable(const std::vector<db::Clip>& clips, const std::vector<db::CaptionVector>& vectors);

  /// Cosines of a vector [width] and every caption. Throws Error for another width.
  std::vector<float> cosines(const std::vector<float>& query) const;
  /// What these mean for each clip, in the order of `clips`.
  std::vector<CaptionMatch> clip_matches(const std::vector<float>& cosines) const;
  /// The captions with the highest cosines, best first.
  std::vector<int32_t> nearest(const std::vector<float>& cosines, size_t count) const;

  const std::string& text(int32_t caption) const { return texts_[static_cast<size_t>(caption)]; }
  size_t size() const { return texts_.size(); }
  /// Clips with a caption that has no vector.
  int64_t incomplete_clips() const { return incomplete_clips_; }

 private:
  std::vector<std::string> texts_;
  std::vector<float> vectors_;  // [texts][width]
  int64_t width_ = 0, incomplete_clips_ = 0;
  std::vector<int64_t> first_;  // of each clip in rows_, and the end
  std::vector<int32_t> rows_;   // captions of the clips
};

}  // namespace remomask::search
