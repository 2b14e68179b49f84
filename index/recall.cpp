#include "index/recall.h"

#include <faiss/IndexIVF.h>

#include <algorithm>
#include <set>
#include <string>

namespace remomask::index {

namespace {

constexpr int64_t kSampleQueries = 100, kRecalled = 10;
constexpr double kTargetRecall = 0.97;

/// The first ten that are not the query itself.
std::vector<VectorHit> without_query(std::vector<VectorHit> hits, int64_t query_id) {
  std::erase_if(hits, [&](const VectorHit& hit) { return hit.clip_id == query_id; });
  hits.resize(std::min(hits.size(), static_cast<size_t>(kRecalled)));
  return hits;
}

}  // namespace

RecallSample::RecallSample(const IndexSegments& segments) {
  const auto count = static_cast<int64_t>(segments.ids().size());
  const int64_t sampled = std::min(count, kSampleQueries);
  for (int64_t i = 0; i < sampled; ++i) {
    ids_.push_back(segments.ids()[static_cast<size_t>(i * count / sampled)]);
  }
  queries_ = segments.vectors_of(ids_);
  const auto found = segments.search_exactly(queries_.data(), sampled, kRecalled + 1, nullptr);
  for (size_t i = 0; i < ids_.size(); ++i) truth_.push_back(without_query(found[i], ids_[i]));
}

double RecallSample::measure(const IndexSegments& segments) const {
  const auto found = segments.search_approximately(
      queries_.data(), static_cast<int64_t>(ids_.size()), kRecalled + 1);
  size_t right = 0, wanted = 0;
  for (size_t i = 0; i < ids_.size(); ++i) {
    std::set<int64_t> nearest;
    for (const VectorHit& hit : truth_[i]) nearest.insert(hit.clip_id);
    wanted += nearest.size();
    for (const VectorHit& hit : without_query(found[i], ids_[i])) {
      right += nearest.count(hit.clip_id);
    }
  }
  return wanted == 0 ? 1 : static_cast<double>(right) / static_cast<double>(wanted);
}

std::string tune_probes(IndexSegments& segments, const RecallSample& sample) {
  auto* lists = dynamic_cast<faiss::IndexIVF*>(segments.base().index);
  if (!lists) return "";
  for (lists->nprobe = 1; lists->nprobe < lists->nlist; lists->nprobe *= 2) {
    if (sample.measure(segments) >= kTargetRecall) break;
  }
  return "nprobe=" + std::to_string(lists->nprobe);
}

}  // namespace remomask::index
