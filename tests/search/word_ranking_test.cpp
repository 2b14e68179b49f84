// The ranking by rough cosines first is the ranking by the cosines themselves.
#include "search/word_ranking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "base/random.h"
#include "remomask/error.h"
#include "tests/db/db_test_tools.h"
#include "tests/index/index_test_tools.h"

namespace remomask {
namespace {

constexpr int kTextWidth = 48, kMotionWidth = 16;
constexpr size_t kRankedClips = 6000;  // several times the candidates

/// A scene in memory: clips with up to three captions, every fiftieth with none.
class WordRankingTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = new search::SearchScene;
    const std::vector<std::string> words = {"walk", "run", "jump", "kick", "left", "right", "turn"};
    CounterRandom random(9, 2);
    std::vector<db::Clip> clips;
    std::vector<int64_t> ids;
    for (size_t i = 0; i < kRankedClips; ++i) {
      db::Clip clip = named_clip("clip" + std::to_string(i));
      clip.id = static_cast<int64_t>(3 * i + 1);
      clip.captions.clear();
      for (uint64_t c = i % 50 == 0 ? 0 : random.below(3) + 1; c > 0; --c) {
        const std::string& word = words[random.below(words.size())];
        clip.captions.push_back(word + " number " + std::to_string(texts_.size()));
        texts_.push_back({clip.captions.back(), {}});
      }
      ids.push_back(clip.id);
      clips.push_back(std::move(clip));
    }
    const auto numbers =
        clustered_directions(static_cast<int64_t>(texts_.size()), kTextWidth, 40, 7);
    for (size_t i = 0; i < texts_.size(); ++i) {
      const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(i * kTextWidth);
      texts_[i].vector.assign(first, first + kTextWidth);
    }
    auto state = std::make_shared<search::SearchState>(
        index::VectorIndex({"test", 0, "r"}, ids,
                           random_directions(static_cast<int64_t>(kRankedClips), kMotionWidth, 8),
                           kMotionWidth),
        std::move(clips));
    const auto texts_of = [&](size_t place) { return state->captions_of(place); };
    scene_->caption_table = std::make_shared<search::CaptionTable>(kRankedClips, texts_of, texts_);
    scene_->word_index = std::make_shared<search::WordIndex>(kRankedClips, texts_of);
    scene_->state = std::move(state);
    score_ = search::WordScore{-5, 3, 4, 1.4, -6, 0.7, 1.7, -10, 10};
  }
  static void TearDownTestSuite() { delete scene_; }

  static search::WordVariant variant(const std::string& text, uint64_t seed) {
    search::WordVariant one;
    one.text = text;
    one.caption_query = clustered_directions(1, kTextWidth, 40, seed);
    // Near a caption, as sentences are.
    for (size_t i = 0; i < one.caption_query.size(); ++i) {
      one.caption_query[i] = 0.6f * one.caption_query[i] + 0.8f * texts_[seed].vector[i];
    }
    one.motion_query = random_directions(1, kMotionWidth, seed + 1);
    one.terms = scene_->word_index->terms(text);
    return one;
  }

  /// By definition: every clip, all digits.
  static std::vector<std::pair<double, int64_t>> by_definition(const search::WordVariant& variant) {
    const search::WordMatches words = scene_->word_index->match(variant.terms);
    const search::SearchState& state = *scene_->state;
    std::vector<std::pair<double, int64_t>> ranked;
    std::map<int64_t, double> motions;
    const auto hits = state.index.search(variant.motion_query.data(), 1, kRankedClips);
    for (const index::VectorHit& hit : hits.front()) {
      motions[hit.clip_id] = hit.similarity;
    }
    const unsigned sides = search::named_sides(variant.text);
    for (size_t place = 0; place < kRankedClips; ++place) {
      search::WordFeatures known;
      known.motion = motions.at(state.clips[place].id);
      const auto match = scene_->caption_table->exact_match(place, variant.caption_query);
      if (match.caption >= 0) {
        known.captions = true;
        known.best = match.best;
        known.mean = match.mean;
        known.words = words.bm25[place];
        known.share = words.share[place];
        const unsigned own = scene_->caption_table->sides(match.caption);
        known.other_side = own != 0 && sides != 0 && (own & sides) == 0;
      }
      ranked.emplace_back(-score_.logit(known), state.clips[place].id);
    }
    std::sort(ranked.begin(), ranked.end());
    return ranked;
  }

  static inline search::SearchScene* scene_;
  static inline std::vector<db::CaptionVector> texts_;
  static inline search::WordScore score_;
};

TEST_F(WordRankingTest, TheFirstHitsAreThoseOfTheExactRanking) {
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const search::WordVariant asked = variant(seed % 2 ? "kicks left" : "runs, number 77", seed);
    const auto truth = by_definition(asked);
    const auto ranked = search::rank_clips(*scene_, {asked}, score_, SearchBy::all, 10);
    ASSERT_GE(ranked.size(), 10u);
    for (size_t i = 0; i < 10; ++i) {
      EXPECT_EQ(ranked[i].clip_id, truth[i].second) << seed << ", place " << i;
      EXPECT_NEAR(ranked[i].score, -truth[i].first, 1e-6);
    }
  }
}

TEST_F(WordRankingTest, ByOnePartEveryClipHasItsPlace) {
  const search::WordVariant asked = variant("kicks", 3);
  for (const SearchBy by : {SearchBy::captions, SearchBy::words}) {
    const auto all = search::rank_clips(*scene_, {asked}, score_, by, kRankedClips);
    const auto first = search::rank_clips(*scene_, {asked}, score_, by, 20);
    ASSERT_GE(first.size(), 20u);
    EXPECT_GT(all.size(), first.size());
    for (size_t i = 0; i < 20; ++i) EXPECT_NEAR(first[i].score, all[i].score, 1e-6);
  }
}

TEST_F(WordRankingTest, AFilterHoldsForClipsWithAndWithoutCaptions) {
  search::SearchScene filtered = *scene_;
  filtered.allowed = std::vector<int64_t>{1, 4, 151, 154};  // 1 and 151 have no captions
  const auto ranked =
      search::rank_clips(filtered, {variant("jumps", 5)}, score_, SearchBy::all, 10);
  std::vector<int64_t> ids;
  for (const search::RankedClip& clip : ranked) ids.push_back(clip.clip_id);
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(ids, *filtered.allowed);
}

TEST_F(WordRankingTest, AGuessedCaptionCountsByItsProbability) {
  const search::SearchState& state = *scene_->state;
  auto guessing = std::make_shared<search::SearchState>(
      index::VectorIndex({"test", 0, "r"}, {state.clips[0].id, state.clips[1].id},
                         random_directions(2, kMotionWidth, 8), kMotionWidth),
      std::vector<db::Clip>{state.clips[0], state.clips[1]},
      std::vector<db::GuessedCaption>{{state.clips[0].id, texts_[0].text, 0.6}});
  ASSERT_TRUE(guessing->clips[0].captions.empty());
  const auto texts_of = [&](size_t place) { return guessing->captions_of(place); };
  search::SearchScene scene;
  scene.caption_table = std::make_shared<search::CaptionTable>(2, texts_of, texts_);
  scene.word_index = std::make_shared<search::WordIndex>(2, texts_of);
  scene.state = guessing;
  search::WordVariant asked = variant(texts_[0].text, 0);
  asked.caption_query = texts_[0].vector;
  asked.terms = scene.word_index->terms(asked.text);
  for (const auto& ranked : search::rank_clips(scene, {asked}, score_, SearchBy::all, 2)) {
    if (ranked.place != 0) continue;
    ASSERT_TRUE(ranked.parts.guess);
    EXPECT_DOUBLE_EQ(*ranked.parts.guess, 0.6);
    EXPECT_EQ(ranked.parts.caption, texts_[0].text);
    EXPECT_LT(ranked.probability, 0.62);
    EXPECT_GT(ranked.probability, 0.4);
  }
}

}  // namespace
}  // namespace remomask
