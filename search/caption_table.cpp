#include "search/caption_table.h"

#include <ATen/ops/from_blob.h>
#include <ATen/ops/mv.h>

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "nn/tensor_values.h"
#include "remomask/error.h"

namespace remomask::search {

CaptionTable::CaptionTable(const std::vector<db::Clip>& clips,
                           const std::vector<db::CaptionVector>& vectors) {
  std::unordered_map<std::string, int32_t> places;
  for (const db::CaptionVector& one : vectors) {
    width_ = static_cast<int64_t>(one.vector.size());
    places.emplace(one.text, static_cast<int32_t>(texts_.size()));
    texts_.push_back(one.text);
    vectors_.insert(vectors_.end(), one.vector.begin(), one.vector.end());
  }
  for (const db::Clip& clip : clips) {
    first_.push_back(static_cast<int64_t>(rows_.size()));
    bool complete = true;
    for (const std::string& caption : clip.captions) {
      const auto place = places.find(caption);
      complete = complete && place != places.end();
      if (place != places.end()) rows_.push_back(place->second);
    }
    if (!complete) ++incomplete_clips_;
  }
  first_.push_back(static_cast<int64_t>(rows_.size()));
}

std::vector<float> CaptionTable::cosines(const std::vector<float>& query) const {
  if (texts_.empty()) return {};
  if (static_cast<int64_t>(query.size()) != width_) {
    throw Error("the vector of the sentence has another width than those of the captions");
  }
  // from_blob() wants pointers that could write; nothing is written.
  const at::Tensor table = at::from_blob(const_cast<float*>(vectors_.data()),
                                         {static_cast<int64_t>(texts_.size()), width_});
  const at::Tensor vector = at::from_blob(const_cast<float*>(query.data()), {width_});
  return nn::float_vector(at::mv(table, vector));
}

std::vector<CaptionMatch> CaptionTable::clip_matches(const std::vector<float>& cosines) const {
  std::vector<CaptionMatch> matches(first_.size() - 1);
  for (size_t clip = 0; clip < matches.size(); ++clip) {
    CaptionMatch& match = matches[clip];
    const auto first = static_cast<size_t>(first_[clip]);
    const auto last = static_cast<size_t>(first_[clip + 1]);
    if (first == last) continue;
    double sum = 0;
    for (size_t i = first; i < last; ++i) {
      const float cosine = cosines[static_cast<size_t>(rows_[i])];
      sum += cosine;
      if (match.caption >= 0 && cosine <= match.best) continue;
      match.best = cosine;
      match.caption = rows_[i];
    }
    match.mean = static_cast<float>(sum / static_cast<double>(last - first));
  }
  return matches;
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

}  // namespace remomask::search
