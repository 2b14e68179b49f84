#include "index/vector_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "index/exact_scan.h"
#include "motion/body_parts.h"
#include "remomask/error.h"

namespace remomask::index {

namespace {

// A row is [global / sqrt 2 | parts / sqrt 12] if it has parts, so that its length is 1.
const double kBodyGlobalScale = std::sqrt(2.0);
const double kBodyPartScale = std::sqrt(2.0 * motion::kBodyParts);

}  // namespace

VectorTable VectorTable::of_bodies(const std::vector<db::ClipEmbedding>& embeddings) {
  if (embeddings.empty()) return {0, 0};
  const db::ClipEmbedding& first = embeddings.front();
  VectorTable table(static_cast<int>(first.motion.size()), static_cast<int>(first.parts.size()));
  for (const db::ClipEmbedding& clip : embeddings) table.add(clip.clip_id, clip.motion, clip.parts);
  return table;
}

VectorTable VectorTable::of_captions(const std::vector<db::ClipEmbedding>& embeddings) {
  const auto first = std::find_if(embeddings.begin(), embeddings.end(),
                                  [](const db::ClipEmbedding& clip) { return !clip.text.empty(); });
  if (first == embeddings.end()) return {0, 0};
  VectorTable table(static_cast<int>(first->text.size()), 0);
  for (const db::ClipEmbedding& clip : embeddings) {
    if (!clip.text.empty()) table.add(clip.clip_id, clip.text, {});
  }
  return table;
}

void VectorTable::add(int64_t id, const std::vector<float>& global,
                      const std::vector<float>& parts) {
  if (global.size() != static_cast<size_t>(global_width_) ||
      parts.size() != static_cast<size_t>(parts_width_)) {
    throw Error(
        fmt::format("the vectors of clip number {} have {} and {} numbers instead of {} "
                    "and {}; run: remomask index DB",
                    id, global.size(), parts.size(), global_width_, parts_width_));
  }
  ids_.push_back(id);
  const bool scaled = parts_width_ > 0;
  for (const float value : global) {
    rows_.push_back(scaled ? static_cast<float>(value / kBodyGlobalScale) : value);
  }
  for (const float value : parts) rows_.push_back(static_cast<float>(value / kBodyPartScale));
}

std::vector<VectorHit> VectorTable::nearest(const LinearQuery& query, int64_t k,
                                            const std::vector<int64_t>* allowed) const {
  if (ids_.empty()) return {};
  if (query.global.size() != static_cast<size_t>(global_width_) ||
      query.parts.size() != static_cast<size_t>(parts_width_)) {
    throw Error(fmt::format("a query of {} and {} numbers does not fit vectors of {} and {}",
                            query.global.size(), query.parts.size(), global_width_, parts_width_));
  }
  std::vector<double> scaled;
  for (const float value : query.global) {
    scaled.push_back(parts_width_ > 0 ? value * kBodyGlobalScale : value);
  }
  for (const float value : query.parts) scaled.push_back(value * kBodyPartScale);
  double square = 0;
  for (const double value : scaled) square += value * value;
  // A query of length 0 is equally far from everything, so any divisor will do.
  const double length = square > 0 ? std::sqrt(square) : 1;
  std::vector<float> unit;
  for (const double value : scaled) unit.push_back(static_cast<float>(value / length));

  std::vector<int64_t> rows;
  if (allowed) {
    for (const int64_t id : *allowed) {
      const auto found = std::lower_bound(ids_.begin(), ids_.end(), id);
      if (found != ids_.end() && *found == id) rows.push_back(found - ids_.begin());
    }
  }
  const auto found = exact_top_k(rows_.data(), count(), global_width_ + parts_width_,
                                 {allowed ? &rows : nullptr, nullptr}, unit.data(), 1, k);
  std::vector<VectorHit> hits;
  for (const RowScore& row : found.front()) {
    hits.push_back({ids_[static_cast<size_t>(row.row)], static_cast<float>(row.score * length)});
  }
  return hits;
}

}  // namespace remomask::index
