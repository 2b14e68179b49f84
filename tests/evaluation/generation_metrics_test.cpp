#include "evaluation/generation_metrics.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include <cmath>
#include <limits>
#include <set>

#include "remomask/error.h"

namespace remomask {
namespace {

at::Tensor diagonal(std::vector<double> values) {
  return torch::diag(torch::tensor(values, torch::kDouble));
}

TEST(FrechetDistance, OfKnownGaussians) {
  const at::Tensor zero = torch::zeros({3}, torch::kDouble);
  const at::Tensor mean = torch::tensor({1.0, 2.0, 2.0}, torch::kDouble);
  // Equal covariances: only the means count.
  EXPECT_NEAR(evaluation::frechet_distance(zero, diagonal({1, 4, 9}), mean, diagonal({1, 4, 9})), 9,
              1e-9);
  // Commuting ones: the squared differences of the deviations, (1-2)^2 + (2-5)^2 + 0.
  EXPECT_NEAR(evaluation::frechet_distance(zero, diagonal({1, 4, 9}), zero, diagonal({4, 25, 9})),
              10, 1e-9);
  // Not commuting: a rotated one, against the trace of the root of [[2, 1], [1, 2]] times
  // diag(1, 4): eigenvalues (10 +- sqrt(52)) / 2.
  const at::Tensor a = torch::tensor({{2.0, 1.0}, {1.0, 2.0}}, torch::kDouble);
  const double trace =
      std::sqrt((10 + std::sqrt(52.0)) / 2) + std::sqrt((10 - std::sqrt(52.0)) / 2);
  EXPECT_NEAR(evaluation::frechet_distance(torch::zeros({2}, torch::kDouble), a,
                                           torch::zeros({2}, torch::kDouble), diagonal({1, 4})),
              4 + 5 - 2 * trace, 1e-9);
  // A singular one.
  EXPECT_NEAR(evaluation::frechet_distance(zero, diagonal({1, 0, 0}), zero, diagonal({0, 1, 0})), 2,
              1e-9);
}

TEST(FrechetDistance, OfSetsUsesUnbiasedCovariances) {
  const at::Tensor a = torch::tensor({{0.f}, {2.f}}), b = torch::tensor({{1.f}, {1.f}, {4.f}});
  // Means 1 and 2, variances 2 and 3.
  const double expected = 1 + std::pow(std::sqrt(2.0) - std::sqrt(3.0), 2);
  EXPECT_NEAR(evaluation::frechet_distance(a, b), expected, 1e-9);
  EXPECT_NEAR(evaluation::frechet_distance(b, a), expected, 1e-9);
  EXPECT_THROW(evaluation::frechet_distance(a, b.slice(0, 0, 1)), Error);
  EXPECT_THROW(evaluation::frechet_distance(a, torch::zeros({3, 2})), Error);
}

TEST(FrechetDistance, OfEqualSetsIsZeroAlsoWithFewRows) {
  torch::manual_seed(1);
  for (const int64_t rows : {200, 10}) {  // 10 rows: the covariance is singular
    const at::Tensor x = torch::randn({rows, 32});
    EXPECT_NEAR(evaluation::frechet_distance(x, x), 0, 1e-5);
    EXPECT_NEAR(evaluation::frechet_distance(x, x + 2), 4 * 32, 1e-4);
  }
}

TEST(FrechetDistance, OfSamplesApproachesTheGaussians) {
  torch::manual_seed(2);
  const at::Tensor x = torch::randn({20000, 4}), y = 2 * torch::randn({20000, 4}) + 1;
  EXPECT_NEAR(evaluation::frechet_distance(x, y), 4 + 4, 0.2);
}

TEST(BatchHits, ByHandWithTies) {
  // Distances of text 0: 1, 2, 0.5; of text 1: 2, 1, 1; of text 2: equal to all.
  const at::Tensor motion = torch::tensor({{1.f, 0.f}, {-2.f, 0.f}, {0.5f, 0.f}});
  const at::Tensor text = torch::tensor({{0.f, 0.f}, {-0.75f, 0.f}, {0.f, 0.f}});
  const auto hits = evaluation::batch_hits(text, motion);
  EXPECT_EQ(hits[0], (evaluation::RPrecision{0, 1, 1}));    // the third motion is nearer
  EXPECT_EQ(hits[1], (evaluation::RPrecision{0.5, 1, 1}));  // 1.75, 1.25, 1.25
  EXPECT_EQ(hits[2], (evaluation::RPrecision{1, 1, 1}));
  const auto equal = evaluation::batch_hits(torch::randn({4, 3}), torch::zeros({4, 3}));
  for (const evaluation::RPrecision& hit : equal)
    EXPECT_EQ(hit, (evaluation::RPrecision{0.25, 0.5, 0.75}));
}

TEST(BatchHits, AMotionThatIsNoNumberIsLast) {
  at::Tensor motion = torch::eye(5), text = torch::eye(5);
  motion[2][0] = std::numeric_limits<float>::quiet_NaN();
  const auto hits = evaluation::batch_hits(text, motion);
  EXPECT_EQ(hits[2], (evaluation::RPrecision{0, 0, 0}));
  EXPECT_EQ(hits[0], (evaluation::RPrecision{1, 1, 1}));
}

TEST(DistinctBatches, KeysNeverMeetAndItemsComeOnce) {
  std::vector<evaluation::BatchKeys> keys;
  for (int i = 0; i < 100; ++i) {
    keys.push_back({"caption " + std::to_string(i / 2), "label " + std::to_string(i % 17)});
  }
  CounterRandom random(3);
  const auto batches = evaluation::distinct_batches(keys, 8, random);
  EXPECT_GE(batches.size(), 9u);
  std::set<int64_t> seen;
  for (const auto& batch : batches) {
    ASSERT_EQ(batch.size(), 8u);
    std::set<std::string> used;
    for (const int64_t item : batch) {
      EXPECT_TRUE(seen.insert(item).second);
      for (const auto& key : keys[static_cast<size_t>(item)]) {
        EXPECT_TRUE(used.insert(key).second);
      }
    }
  }
  // All alike: no batch.
  EXPECT_TRUE(evaluation::distinct_batches(std::vector<evaluation::BatchKeys>(20, {"x"}), 2, random)
                  .empty());
  // No keys: plain shuffled batches, the rest left out.
  EXPECT_EQ(evaluation::distinct_batches(std::vector<evaluation::BatchKeys>(20), 8, random).size(),
            2u);
}

TEST(Distances, MatchingAndDiversityByHand) {
  const at::Tensor text = torch::tensor({{0.f, 0.f}, {1.f, 1.f}});
  const at::Tensor motion = torch::tensor({{3.f, 4.f}, {1.f, 2.f}});
  EXPECT_NEAR(evaluation::matching_distance(text, motion), 3, 1e-9);
  CounterRandom random(1);
  // Two rows, two pairs: both with themselves (0) or both crossed.
  const double crossed = std::sqrt(8.0);
  std::set<int> seen;
  for (int i = 0; i < 40; ++i) {
    const double value = evaluation::diversity(motion, 2, random);
    ASSERT_TRUE(std::abs(value) < 1e-9 || std::abs(value - crossed) < 1e-6) << value;
    seen.insert(value > 1);
  }
  EXPECT_EQ(seen.size(), 2u);
  EXPECT_EQ(evaluation::diversity(torch::ones({5, 3}), 5, random), 0);
  EXPECT_THROW(evaluation::diversity(motion, 3, random), Error);
}

TEST(Distances, DiversityOfStandardNormals) {
  torch::manual_seed(3);
  CounterRandom random(1);
  // Distance of two normals in many dimensions: sqrt(2 E), a little less.
  EXPECT_NEAR(evaluation::diversity(torch::randn({2000, 512}), 300, random), std::sqrt(2 * 511.5),
              0.3);
}

TEST(Multimodality, ByHand) {
  CounterRandom random(1);
  EXPECT_EQ(evaluation::multimodality(torch::ones({3, 4, 2}), 2, random), 0);
  // Two generations 2 apart: all picks of both orders give 0 or 2.
  const at::Tensor motions = torch::tensor({{{0.f}, {2.f}}, {{5.f}, {7.f}}});
  double sum = 0;
  for (int i = 0; i < 400; ++i) {
    const double value = evaluation::multimodality(motions, 1, random);
    ASSERT_TRUE(value == 0 || value == 2);  // the same picks for all captions
    sum += value;
  }
  EXPECT_NEAR(sum / 400, 1, 0.2);
  EXPECT_THROW(evaluation::multimodality(motions, 3, random), Error);
}

TEST(Figures, MeanAndInterval) {
  const evaluation::Figure figure = evaluation::figure_of({1, 2, 3, 6});
  EXPECT_NEAR(figure.mean, 3, 1e-12);
  EXPECT_NEAR(figure.interval, 1.96 * std::sqrt(14.0 / 4) / 2, 1e-12);
}

evaluation::EmbeddedPairs perfect_pairs(int64_t count) {
  torch::manual_seed(4);
  evaluation::EmbeddedPairs pairs;
  pairs.text = pairs.motion = pairs.real = torch::randn({count, 16});
  for (int64_t i = 0; i < count; ++i) pairs.keys.push_back({std::to_string(i)});
  return pairs;
}

TEST(MeasurePairs, IdenticalSetsArePerfectAndShuffledOnesChance) {
  evaluation::EmbeddedPairs pairs = perfect_pairs(640);
  const evaluation::GenerationFigureOptions options;
  evaluation::GenerationFigures figures = evaluation::measure_pairs({pairs}, options);
  EXPECT_EQ(figures.motions, 640);
  EXPECT_EQ(figures.ranked, 640);
  EXPECT_NEAR(figures.fid.mean, 0, 1e-6);
  EXPECT_EQ(figures.mm_dist.mean, 0);
  for (const evaluation::Figure& top : figures.r_precision) EXPECT_NEAR(top.mean, 1, 1e-12);

  pairs.motion = pairs.motion.roll(7, 0);
  figures = evaluation::measure_pairs({pairs}, options);
  EXPECT_NEAR(figures.fid.mean, 0, 1e-6);
  for (int k = 1; k <= evaluation::kMostRank; ++k) {
    const double chance = k / 32.0;
    EXPECT_NEAR(figures.r_precision[static_cast<size_t>(k - 1)].mean, chance,
                3 * std::sqrt(chance * (1 - chance) / 640));
  }
  EXPECT_GT(figures.mm_dist.mean, 4);
}

TEST(MeasurePairs, MembersAreRankedAmongAll) {
  evaluation::EmbeddedPairs pairs = perfect_pairs(64);
  // The first half says the texts' opposite.
  pairs.motion = pairs.motion.clone();
  pairs.motion.narrow(0, 0, 32).mul_(-1);
  std::vector<bool> right(64), wrong(64);
  for (size_t i = 0; i < 64; ++i) (i < 32 ? wrong : right)[i] = true;
  evaluation::GenerationFigureOptions options;
  options.draws = 4;
  const auto good = evaluation::measure_pairs({pairs}, options, right);
  const auto bad = evaluation::measure_pairs({pairs}, options, wrong);
  EXPECT_EQ(good.motions, 32);
  EXPECT_EQ(good.ranked, 32);
  EXPECT_NEAR(good.r_precision[0].mean, 1, 1e-12);
  EXPECT_NEAR(good.fid.mean, 0, 1e-6);
  EXPECT_LT(bad.r_precision[0].mean, 0.1);
  EXPECT_GT(bad.fid.mean, 0.1);
  EXPECT_EQ(evaluation::measure_pairs({pairs}, options, std::vector<bool>(64, false)).motions, 0);
  EXPECT_THROW(evaluation::measure_pairs({pairs}, options, std::vector<bool>(3)), Error);
}

TEST(MeasurePairs, RunsTakeTurns) {
  evaluation::EmbeddedPairs good = perfect_pairs(64), bad = good;
  bad.motion = bad.motion + 3;
  evaluation::GenerationFigureOptions options;
  options.draws = 4;
  const auto figures = evaluation::measure_pairs({good, bad}, options);
  EXPECT_NEAR(figures.fid.mean, 9 * 16 / 2.0, 1e-3);
  EXPECT_NEAR(figures.fid.interval, 1.96 * 72 / 2, 1e-3);
}

TEST(MeasurePairs, WithoutFullBatchRPrecisionIsNoNumber) {
  const auto figures = evaluation::measure_pairs({perfect_pairs(20)}, {});
  EXPECT_TRUE(std::isnan(figures.r_precision[0].mean));
  EXPECT_NEAR(figures.mm_dist.mean, 0, 1e-9);
}

}  // namespace
}  // namespace remomask
