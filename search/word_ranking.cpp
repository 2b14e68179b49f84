#include "search/word_ranking.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "search/caption_table.h"

namespace remomask::search {

namespace {

// The rough cosines of captions are wrong by up to 0.003, and motions shift the log-odds by less
// than one, so that the first ten of the final ranking are among so many first by the rough one
// (tests/search/word_ranking_test.cpp).
constexpr size_t kFewestCandidates = 1024;
constexpr size_t kCandidatesForOne = 8;
// Of the clips without captions, which only their motions speak for.
constexpr size_t kFewestMotions = 256;

struct Found {
  RankedClip clip;
  WordFeatures features;
};

class VariantRanking {
 public:
  VariantRanking(const SearchScene& scene, const WordVariant& variant, const WordScore& score,
                 SearchBy by)
      : scene_(scene),
        table_(*scene.caption_table),
        variant_(variant),
        score_(score),
        by_(by),
        sides_(named_sides(variant.text)),
        words_(scene.word_index->match(variant.terms)) {}

  std::vector<RankedClip> first(size_t count) const {
    std::vector<Found> found;
    for (const size_t place : candidates(std::max(kFewestCandidates, kCandidatesForOne * count))) {
      const CaptionMatch match = table_.exact_match(place, variant_.caption_query);
      // The mirror image of a clip differs where its captions name a side.
      if (variant_.mirrored && table_.sides(match.caption) == 0) continue;
      found.push_back({clip_at(place), features(place, match)});
      if (match.caption >= 0) found.back().clip.parts.caption = table_.text(match.caption);
    }
    if (by_ == SearchBy::all) {
      add_motions(found);
      if (!variant_.mirrored) add_undescribed(std::max(kFewestMotions, count), found);
    }
    std::vector<RankedClip> ranked;
    for (Found& one : found) {
      finish(one);
      ranked.push_back(std::move(one.clip));
    }
    return ranked;
  }

 private:
  /// The described clips that can be among the first, by the rough cosines.
  std::vector<size_t> candidates(size_t count) const {
    const std::vector<float> rough = table_.rough_cosines(variant_.caption_query);
    std::vector<std::pair<double, size_t>> found;
    const size_t clips = scene_.state->clips.size();
    for (size_t place = 0; place < clips; ++place) {
      const CaptionMatch match = table_.rough_match(place, rough);
      // By words alone a clip is found by its tags, too.
      if (by_ == SearchBy::words ? words_.bm25[place] <= 0 : match.caption < 0) continue;
      if (!is_allowed(place)) continue;
      if (variant_.mirrored && !table_.names_side(place)) continue;
      found.emplace_back(-value(features(place, match)), place);
    }
    if (found.size() > count) {
      const auto end = found.begin() + static_cast<std::ptrdiff_t>(count);
      std::nth_element(found.begin(), end, found.end());
      found.erase(end, found.end());
    }
    std::vector<size_t> places;
    for (const auto& [value, place] : found) places.push_back(place);
    return places;
  }

  WordFeatures features(size_t place, const CaptionMatch& match) const {
    WordFeatures features;
    features.words = words_.bm25[place];
    features.share = words_.share[place];
    if (match.caption < 0) return features;
    features.captions = true;
    features.best = match.best;
    features.mean = match.mean;
    const unsigned sides = table_.sides(match.caption);
    features.other_side = sides != 0 && sides_ != 0 && (sides & sides_) == 0;
    features.described = scene_.state->described(place, table_.text(match.caption));
    return features;
  }

  RankedClip clip_at(size_t place) const {
    RankedClip clip;
    clip.clip_id = scene_.state->clips[place].id;
    clip.place = place;
    clip.as_mirrored = variant_.mirrored;
    return clip;
  }

  void add_motions(std::vector<Found>& found) const {
    if (variant_.motion_query.empty() || found.empty()) return;
    std::unordered_map<int64_t, Found*> clips;
    std::vector<int64_t> ids;
    for (Found& one : found) {
      ids.push_back(one.clip.clip_id);
      clips[ids.back()] = &one;
    }
    std::sort(ids.begin(), ids.end());
    const auto hits = scene_.state->index.search(variant_.motion_query.data(), 1,
                                                 static_cast<int64_t>(ids.size()), &ids);
    for (const index::VectorHit& hit : hits.front()) {
      clips.at(hit.clip_id)->features.motion = hit.similarity;
    }
  }

  /// The clips without captions that have the most similar motions.
  void add_undescribed(size_t count, std::vector<Found>& found) const {
    if (variant_.motion_query.empty()) return;
    std::vector<int64_t> ids;
    for (size_t place = 0; place < scene_.state->clips.size(); ++place) {
      if (table_.has_captions(place) || !is_allowed(place)) continue;
      ids.push_back(scene_.state->clips[place].id);
    }
    if (ids.empty()) return;
    const auto nearest = scene_.state->index.search(variant_.motion_query.data(), 1,
                                                    static_cast<int64_t>(count), &ids);
    for (const index::VectorHit& hit : nearest.front()) {
      Found& one = found.emplace_back();
      one.clip = clip_at(scene_.state->place(hit.clip_id));
      one.features.motion = hit.similarity;
    }
  }

  double value(const WordFeatures& features) const {
    return by_ == SearchBy::captions ? features.best
           : by_ == SearchBy::words  ? features.words
                                     : score_.logit(features);
  }

  void finish(Found& one) const {
    const WordFeatures& features = one.features;
    WordParts& parts = one.clip.parts;
    if (features.captions) {
      parts.best = features.best;
      parts.mean = features.mean;
      if (features.described < 1) parts.guess = features.described;
    }
    parts.words = features.words;
    parts.share = features.share;
    parts.motion = features.motion;
    one.clip.score = value(features);
    one.clip.probability = score_.probability(features);
  }

  /// Without a filter no clip is touched: to fetch 100,000 of them takes longer than all the rest.
  bool is_allowed(size_t place) const {
    const auto* limit = scene_.limit();
    return !limit ||
           std::binary_search(limit->begin(), limit->end(), scene_.state->clips[place].id);
  }

  const SearchScene& scene_;
  const CaptionTable& table_;
  const WordVariant& variant_;
  const WordScore& score_;
  SearchBy by_;
  unsigned sides_;
  WordMatches words_;
};

}  // namespace

std::vector<RankedClip> rank_clips(const SearchScene& scene,
                                   const std::vector<WordVariant>& variants, const WordScore& score,
                                   SearchBy by, size_t count) {
  std::vector<RankedClip> ranked;
  for (const WordVariant& variant : variants) {
    std::vector<RankedClip> found = VariantRanking(scene, variant, score, by).first(count);
    std::move(found.begin(), found.end(), std::back_inserter(ranked));
  }
  std::sort(ranked.begin(), ranked.end(), [](const RankedClip& left, const RankedClip& right) {
    if (left.score != right.score) return left.score > right.score;
    if (left.clip_id != right.clip_id) return left.clip_id < right.clip_id;
    return !left.as_mirrored && right.as_mirrored;
  });
  return ranked;
}

}  // namespace remomask::search
