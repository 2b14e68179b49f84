#include "search/word_score.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "remomask/error.h"

namespace remomask {
namespace {

search::WordFeatures worded(double best, double words) {
  search::WordFeatures features;
  features.captions = true;
  features.best = best;
  features.mean = best - 0.1;
  features.words = words;
  features.motion = 0.2;
  return features;
}

TEST(WordScoreTest, LogOddsAreTheSumOfTheParts) {
  search::WordScore score;
  score.bias = -1;
  score.best = 2;
  score.mean = 3;
  score.words = 4;
  score.motion = 5;
  score.share = 6;
  score.other_side = -7;
  score.motion_only_bias = -8;
  score.motion_only = 9;
  search::WordFeatures features = worded(0.5, 0.25);
  features.share = 0.5;
  EXPECT_DOUBLE_EQ(score.logit(features), -1 + 2 * 0.5 + 3 * 0.4 + 4 * 0.25 + 5 * 0.2 + 6 * 0.5);
  features.other_side = true;
  EXPECT_DOUBLE_EQ(score.logit(features), -1 + 1 + 1.2 + 1 + 1 + 3 - 7);
  features.captions = false;
  EXPECT_DOUBLE_EQ(score.logit(features), -8 + 9 * 0.2);
  features.motion.reset();
  EXPECT_DOUBLE_EQ(score.probability(features), 1 / (1 + std::exp(8.0)));
}

TEST(WordScoreTest, TheFitFindsTheWeightsThatMadeThePairs) {
  search::WordScore truth;
  truth.bias = -4;
  truth.best = 6;
  truth.words = 3;
  CounterRandom random(3, 1);
  std::vector<search::JudgedFeatures> pairs;
  for (int i = 0; i < 20000; ++i) {
    search::JudgedFeatures pair;
    pair.features = worded(random.uniform(), random.uniform());
    pair.right = random.uniform() < truth.probability(pair.features);
    pairs.push_back(pair);
  }
  const search::WordScore fitted = search::fit_word_score(pairs, pairs);
  // best and mean differ by a constant, so that only their sum can be known.
  EXPECT_NEAR(fitted.best + fitted.mean, 6, 0.4);
  EXPECT_NEAR(fitted.words, 3, 0.2);
  double error = 0;
  for (const auto& pair : pairs) {
    error += std::abs(fitted.probability(pair.features) - truth.probability(pair.features));
  }
  EXPECT_LT(error / 20000, 0.01);
}

TEST(WordScoreTest, NoWeightSaysThatLikenessIsBad) {
  std::vector<search::JudgedFeatures> pairs;
  for (int i = 0; i < 100; ++i) {
    search::JudgedFeatures pair;
    pair.features = worded(0.01 * i, 0.5);
    pair.right = i < 50;
    pairs.push_back(pair);
  }
  const search::WordScore fitted = search::fit_word_score(pairs, pairs);
  EXPECT_EQ(fitted.best, 0);
  EXPECT_EQ(fitted.mean, 0);
  EXPECT_NEAR(fitted.probability(worded(0.9, 0.5)), 0.5, 0.01);
}

TEST(WordScoreTest, RefusesTooFewPairsAndPairsOfOneKind) {
  std::vector<search::JudgedFeatures> pairs(19);
  pairs[0].right = true;
  EXPECT_THROW(search::fit_word_score(pairs, pairs), Error);
  pairs.resize(40);
  pairs[0].right = false;
  EXPECT_THROW(search::fit_word_score(pairs, pairs), Error);
}

}  // namespace
}  // namespace remomask
