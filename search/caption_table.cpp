#include "search/caption_table.h"

#include <algorithm>
#include <numeric>
#include <string_view>
#include <unordered_map>

#include "remomask/error.h"
#include "text/caption.h"
#include "text/words.h"

namespace remomask::search {

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
    const float* const vector = vectors_.data() + row * width_;
    return static_cast<float>(std::inner_product(query.begin(), query.end(), vector, 0.0));
  });
}

std::vector<int32_t> CaptionTable::nearest(const std::vector<float>& cosines, size_t count) const {
  std::vector<int32_t> order(cosines.size());
  std::iota(order.begin(), order.end(), 0);
  const auto better = [&](int32_t left, int32_t right) {
    const float a = cosines[static_cast<size_t>(left)], b = cosines[static_cast<size_t>(right)];
    return a != b ? a > b : left < right;
  };
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(count, order.size()));
  std::partial_sort(order.begin(), end, order.end(), better);
  order.erase(end, order.end());
  return order;
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
