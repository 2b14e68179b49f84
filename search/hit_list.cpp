#include "search/hit_list.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <unordered_map>

#include "remomask/error.h"
#include "search/fusion.h"

namespace remomask::search {

namespace {

/// The nearest clips of a query, as many as requested.
class NearestClips {
 public:
  NearestClips(const SearchScene& scene, index::LinearQuery query)
      : scene_(scene), query_(std::move(query)) {
    if (!query_.parts.empty()) return;
    double square = 0;
    for (const float value : query_.global) square += static_cast<double>(value) * value;
    length_ = std::sqrt(square);
    if (length_ < 1e-6) {
      throw Error("the sentence and the motion cancel each other out; change their weights");
    }
    for (float& value : query_.global) value = static_cast<float>(value / length_);
  }

  std::vector<index::VectorHit> best(int64_t k) const {
    if (!query_.parts.empty()) return scene_.bodies->nearest(query_, k, scene_.limit());
    auto hits = scene_.state->index.search(query_.global.data(), 1, k, scene_.limit()).front();
    for (index::VectorHit& hit : hits)
      hit.similarity = static_cast<float>(hit.similarity * length_);
    return hits;
  }

 private:
  const SearchScene& scene_;
  index::LinearQuery query_;
  double length_ = 1;
};

class HitList {
 public:
  HitList(const SearchScene& scene, const SearchQuery& query) : scene_(scene), query_(query) {}

  bool full() const { return static_cast<int>(answer_.hits.size()) == query_.k; }

  /// In a ranking by similarity, nothing after it passes, either.
  bool refused_last() const { return refused_last_; }

  void add(const index::VectorHit& found) {
    MotionHit hit;
    hit.similarity = found.similarity;
    if (scene_.calibration) hit.probability = scene_.calibration->probability(found.similarity);
    add(found.clip_id, std::move(hit));
  }

  /// A hit of which clip, rank and folded clips are still to be entered.
  void add(int64_t clip_id, MotionHit hit) {
    refused_last_ = false;
    const db::Clip& clip = scene_.state->clip(clip_id);
    if (query_.grouped && !seen_.insert(clip.group).second) return;
    hit.clip = clip;
    if (query_.grouped) {
      hit.folded = static_cast<int>(scene_.candidates(scene_.state->groups.at(clip.group))) - 1;
    }
    if (is_refused(hit)) {
      if (!answer_.refused || hit.similarity > answer_.refused->similarity) {
        answer_.refused = std::move(hit);
      }
      refused_last_ = true;
      return;
    }
    hit.rank = static_cast<int>(answer_.hits.size()) + 1;
    answer_.hits.push_back(std::move(hit));
  }

  SearchAnswer finish() {
    answer_.unsearched =
        static_cast<int64_t>(scene_.state->clips.size()) - scene_.state->index.count();
    answer_.boosted = scene_.candidates(scene_.boosted);
    answer_.candidates =
        scene_.allowed ? scene_.candidates(*scene_.allowed) : scene_.state->index.count();
    return std::move(answer_);
  }

 private:
  bool is_refused(const MotionHit& hit) const {
    return (query_.min_similarity && hit.similarity < *query_.min_similarity) ||
           (query_.min_probability && hit.probability < *query_.min_probability);
  }

  const SearchScene& scene_;
  const SearchQuery& query_;
  std::set<std::string> seen_;
  SearchAnswer answer_;
  bool refused_last_ = false;
};

/// All clips ranked by similarity and the clips with boost words ranked by these, as one ranking.
std::vector<index::VectorHit> join_rankings(const std::vector<index::VectorHit>& nearest,
                                            const SearchScene& scene, double boost_weight) {
  Ranking by_vector, by_words;
  by_words.weight = boost_weight;
  std::unordered_map<int64_t, float> similarities;
  for (const index::VectorHit& hit : nearest) {
    by_vector.ids.push_back(hit.clip_id);
    similarities[hit.clip_id] = hit.similarity;
  }
  std::copy_if(scene.boosted.begin(), scene.boosted.end(), std::back_inserter(by_words.ids),
               [&](int64_t id) { return similarities.contains(id); });
  std::vector<index::VectorHit> joined;
  for (const FusedId& fused : reciprocal_rank_fusion({by_vector, by_words})) {
    joined.push_back({fused.id, similarities.at(fused.id)});
  }
  return joined;
}

}  // namespace

SearchAnswer collect_hits(const SearchScene& scene, const SearchQuery& query,
                          const index::LinearQuery& vectors) {
  const NearestClips nearest(scene, vectors);
  const int64_t count = scene.state->index.count();
  if (!scene.boosted.empty()) {
    HitList list(scene, query);
    for (const index::VectorHit& hit :
         join_rankings(nearest.best(count), scene, query.boost_weight)) {
      if (list.full()) break;
      list.add(hit);
    }
    return list.finish();
  }
  // Grouping leaves gaps: look further until there are enough hits or no more clips.
  for (int64_t wanted = std::min<int64_t>(query.k, count);; wanted = std::min(4 * wanted, count)) {
    HitList list(scene, query);
    const std::vector<index::VectorHit> found = nearest.best(wanted);
    for (const index::VectorHit& hit : found) {
      if (list.full()) break;
      list.add(hit);
    }
    const bool exhausted = static_cast<int64_t>(found.size()) < wanted || wanted == count;
    if (list.full() || exhausted || list.refused_last()) return list.finish();
  }
}

SearchAnswer collect_ranked(const SearchScene& scene, const SearchQuery& query,
                            const std::vector<RankedClip>& ranked) {
  HitList list(scene, query);
  for (const RankedClip& clip : ranked) {
    if (list.full()) break;
    MotionHit hit;
    const WordParts& parts = clip.parts;
    hit.similarity = static_cast<float>(query.by == SearchBy::captions ? parts.best.value_or(-1)
                                        : query.by == SearchBy::words  ? parts.words
                                                                       : parts.motion.value_or(-1));
    if (query.by == SearchBy::all) hit.probability = clip.probability;
    hit.as_mirrored = clip.as_mirrored;
    hit.parts = parts;
    list.add(clip.clip_id, std::move(hit));
  }
  return list.finish();
}

}  // namespace remomask::search
