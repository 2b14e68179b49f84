#include "search/caption_table.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <string_view>
#include <unordered_map>

#include "remomask/error.h"
#include "text/caption.h"
#include "text/words.h"

namespace remomask::search {

namespace {

/// In eight sums side by side: one sum would wait for itself at every number.
float long_product(const float* left, const float* right, int64_t width) {
  constexpr int64_t kSums = 8;
  double sums[kSums] = {};
  int64_t i = 0;
  for (; i + kSums <= width; i += kSums) {
    for (int64_t s = 0; s < kSums; ++s) {
      sums[s] += static_cast<double>(left[i + s]) * right[i + s];
    }
  }
  for (; i < width; ++i) sums[0] += static_cast<double>(left[i]) * right[i];
  return static_cast<float>(std::accumulate(std::begin(sums), std::end(sums), 0.0));
}

}  // namespace

CaptionTable::CaptionTable(size_t clips,
                           const std::function<std::vector<std::string>(size_t)>& texts_of,
                           const std::vector<db::CaptionVector>& vectors) {
  std::unordered_map<std::string_view, const db::CaptionVector*> known;
  for (const db::CaptionVector& one : vectors) known.emplace(one.text, &one);
  if (!vectors.empty()) width_ = static_cast<int64_t>(vectors.front().vector.size());
  vectors_.reserve(vectors.size() * static_cast<size_t>(width_));
  // In the order of the clips, so that the captions of one lie together.
  std::unordered_map<std::string_view, int32_t> places;
  for (size_t clip = 0; clip < clips; ++clip) {
    first_.push_back(rows_.size());
    bool complete = true;
    for (const std::string& text : texts_of(clip)) {
      const auto vector = known.find(text);
      complete = complete && vector != known.end();
      if (vector == known.end()) continue;
      const auto [place, is_new] =
          places.emplace(vector->first, static_cast<int32_t>(texts_.size()));
      rows_.push_back(place->second);
      if (!is_new) continue;
      texts_.push_back(text);
      sides_.push_back(static_cast<uint8_t>(named_sides(text)));
      const std::vector<float>& numbers = vector->second->vector;
      vectors_.insert(vectors_.end(), numbers.begin(), numbers.end());
    }
    if (!complete) ++incomplete_clips_;
  }
  first_.push_back(rows_.size());
  rough_ = QuantizedRows(vectors_, width_);
}

std::vector<float> CaptionTable::rough_cosines(const std::vector<float>& query) const {
  if (texts_.empty()) return {};
  if (static_cast<int64_t>(query.size()) != width_) {
    throw Error("the vector of the sentence has another width than those of the captions");
  }
  return rough_.products(query);
}

CaptionMatch CaptionTable::exact_match(size_t clip, const std::vector<float>& query) const {
  return match(clip, [&](int32_t row) {
    return long_product(query.data(), vectors_.data() + row * width_, width_);
  });
}

bool CaptionTable::names_side(size_t clip) const {
  return std::any_of(rows_.begin() + static_cast<std::ptrdiff_t>(first_[clip]),
                     rows_.begin() + static_cast<std::ptrdiff_t>(first_[clip + 1]),
                     [&](int32_t row) { return sides(row) != 0; });
}

unsigned named_sides(const std::string& text) {
  unsigned sides = 0;
  for (const std::string& word : text::split_words(text::normalise_caption(text))) {
    // A word that the mirror exchanges names a side; "left", the past of "leave", does not.
    if (word.starts_with("left") || word.starts_with("counterclock") ||
        word.starts_with("anticlock")) {
      sides |= 1u;
    } else if (word.starts_with("right") || word.starts_with("clockwise")) {
      sides |= 2u;
    }
  }
  return sides;
}

}  // namespace remomask::search
