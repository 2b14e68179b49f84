#include "search/word_ranking.h"

#include <algorithm>
#include <unordered_map>

#include "search/caption_table.h"
#include "text/caption.h"
#include "text/caption_mirror.h"
#include "text/words.h"

namespace remomask::search {

namespace {

// Clips whose motions are compared: those with the best captions, and those with the most similar
// motions. What is in neither list has no chance to come first.
constexpr size_t kWordCandidates = 512;
constexpr int64_t kMotionCandidates = 256;

struct Scored {
  size_t place = 0;  // of the clip in SearchState::clips
  WordFeatures features;
  int32_t caption = -1;
};

class VariantRanking {
 public:
  VariantRanking(const SearchScene& scene, const WordVariant& variant, const WordScore& score)
      : scene_(scene), variant_(variant), score_(score), sides_(named_sides(variant.text)) {
    const CaptionTable& table = *scene.caption_table;
    matches_ = table.clip_matches(table.cosines(variant.caption_query));
    double best = 0;
    for (const db::CaptionMatch& match : variant.matches) best = std::max(best, -match.bm25);
    if (best <= 0) return;
    for (const db::CaptionMatch& match : variant.matches) {
      words_[match.clip_id] = std::max(0.0, -match.bm25) / best;
    }
  }

  std::vector<Scored> by_words() const {
    std::vector<Scored> found;
    const std::vector<db::Clip>& clips = scene_.state->clips;
    for (size_t place = 0; place < clips.size(); ++place) {
      const CaptionMatch& match = matches_[place];
      if (match.caption < 0 || !is_allowed(clips[place].id)) continue;
      Scored one{place, {}, match.caption};
      one.features.captions = true;
      one.features.best = match.best;
      one.features.mean = match.mean;
      add_words(clips[place].id, one.features);
      found.push_back(one);
    }
    return found;
  }

  /// The clips that by_words() found and those with the most similar motions, with the cosines of
  /// their motions.
  std::vector<Scored> with_motions(std::vector<Scored> found) const {
    if (variant_.motion_query.empty() || scene_.state->index.count() == 0) return found;
    keep_best(found, kWordCandidates);
    std::unordered_map<int64_t, size_t> places;
    std::vector<int64_t> ids;
    for (size_t i = 0; i < found.size(); ++i) {
      ids.push_back(scene_.state->clips[found[i].place].id);
      places[ids.back()] = i;
    }
    std::sort(ids.begin(), ids.end());
    add_motions(ids, static_cast<int64_t>(ids.size()), places, found);
    const auto nearest = scene_.state->index.search(variant_.motion_query.data(), 1,
                                                    kMotionCandidates, scene_.limit());
    for (const index::VectorHit& hit : nearest.front()) {
      if (places.contains(hit.clip_id)) continue;
      Scored one = unworded(hit.clip_id);
      one.features.motion = hit.similarity;
      found.push_back(one);
    }
    return found;
  }

  RankedClip ranked(const Scored& one, SearchBy by) const {
    const db::Clip& clip = scene_.state->clips[one.place];
    WordFeatures features = one.features;
    RankedClip result;
    result.clip_id = clip.id;
    result.as_mirrored = variant_.mirrored;
    if (one.caption >= 0) {
      result.parts.caption = scene_.caption_table->text(one.caption);
      result.parts.best = features.best;
      result.parts.mean = features.mean;
      const unsigned sides = named_sides(result.parts.caption);
      features.other_side = sides != 0 && sides_ != 0 && (sides & sides_) == 0;
    }
    result.parts.words = features.words;
    result.parts.share = features.share;
    result.parts.motion = features.motion;
    result.probability = score_.probability(features);
    result.score = by == SearchBy::captions ? features.best
                   : by == SearchBy::words  ? features.words
                                            : score_.logit(features);
    return result;
  }

  /// Whether the mirror image of a clip differs in what its captions say.
  bool names_side(const Scored& one) const {
    return one.caption >= 0 && named_sides(scene_.caption_table->text(one.caption)) != 0;
  }

 private:
  bool is_allowed(int64_t id) const {
    const auto* limit = scene_.limit();
    return !limit || std::binary_search(limit->begin(), limit->end(), id);
  }

  void add_words(int64_t id, WordFeatures& features) const {
    const auto words = words_.find(id);
    if (words != words_.end()) features.words = words->second;
    const auto share = variant_.shares.find(id);
    if (share != variant_.shares.end()) features.share = share->second;
  }

  Scored unworded(int64_t id) const {
    const db::Clip& clip = scene_.state->clip(id);
    const auto place = static_cast<size_t>(&clip - scene_.state->clips.data());
    Scored one{place, {}, matches_[place].caption};
    one.features.captions = one.caption >= 0;
    if (one.features.captions) {
      one.features.best = matches_[place].best;
      one.features.mean = matches_[place].mean;
      add_words(id, one.features);
    }
    return one;
  }

  void keep_best(std::vector<Scored>& found, size_t count) const {
    if (found.size() <= count) return;
    std::vector<std::pair<double, size_t>> order;
    for (size_t i = 0; i < found.size(); ++i)
      order.emplace_back(-score_.logit(found[i].features), i);
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(order.begin(), end, order.end());
    std::vector<Scored> kept;
    for (auto one = order.begin(); one != end; ++one) kept.push_back(found[one->second]);
    found = std::move(kept);
  }

  void add_motions(const std::vector<int64_t>& ids, int64_t count,
                   const std::unordered_map<int64_t, size_t>& places,
                   std::vector<Scored>& found) const {
    if (ids.empty()) return;
    const auto hits = scene_.state->index.search(variant_.motion_query.data(), 1, count, &ids);
    for (const index::VectorHit& hit : hits.front()) {
      found[places.at(hit.clip_id)].features.motion = hit.similarity;
    }
  }

  const SearchScene& scene_;
  const WordVariant& variant_;
  const WordScore& score_;
  unsigned sides_;
  std::vector<CaptionMatch> matches_;
  std::unordered_map<int64_t, double> words_;
};

}  // namespace

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

std::vector<RankedClip> rank_clips(const SearchScene& scene,
                                   const std::vector<WordVariant>& variants, const WordScore& score,
                                   SearchBy by) {
  std::vector<RankedClip> ranked;
  for (const WordVariant& variant : variants) {
    const VariantRanking ranking(scene, variant, score);
    std::vector<Scored> found = ranking.by_words();
    if (by == SearchBy::all) found = ranking.with_motions(std::move(found));
    for (const Scored& one : found) {
      if (variant.mirrored && !ranking.names_side(one)) continue;
      if (by == SearchBy::words && one.features.words <= 0) continue;
      ranked.push_back(ranking.ranked(one, by));
    }
  }
  std::sort(ranked.begin(), ranked.end(), [](const RankedClip& left, const RankedClip& right) {
    if (left.score != right.score) return left.score > right.score;
    if (left.clip_id != right.clip_id) return left.clip_id < right.clip_id;
    return !left.as_mirrored && right.as_mirrored;
  });
  return ranked;
}

}  // namespace remomask::search
