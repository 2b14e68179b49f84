#include "search/calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "remomask/error.h"

namespace remomask {
namespace {

TEST(Calibration, PoolsAdjacentViolatorsByHand) {
  // By score: 0, 1 0, 1 1 0, 1; the second block pools to 1/2, the third to 2/3.
  const search::Calibration calibration = search::fit_calibration(
      {0.7, 0.1, 0.3, 0.2, 0.4, 0.5, 0.6}, {true, false, false, true, true, true, false});
  EXPECT_EQ(calibration.scores(), (std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.6, 0.7}));
  const std::vector<double> expected = {0, 0.5, 0.5, 2. / 3, 2. / 3, 1};
  ASSERT_EQ(calibration.probabilities().size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(calibration.probabilities()[i], expected[i], 1e-12) << i;
  }
  EXPECT_EQ(calibration.pairs(), 7);
  EXPECT_DOUBLE_EQ(calibration.probability(-5), 0);
  EXPECT_DOUBLE_EQ(calibration.probability(0.25), 0.5);
  EXPECT_NEAR(calibration.probability(0.35), (0.5 + 2. / 3) / 2, 1e-12);
  EXPECT_DOUBLE_EQ(calibration.probability(0.7), 1);
  EXPECT_DOUBLE_EQ(calibration.probability(9), 1);
}

TEST(Calibration, EqualScoresHaveOneShare) {
  const search::Calibration calibration =
      search::fit_calibration({0.5, 0.5, 0.5, 0.5, 0.8}, {true, false, false, false, true});
  EXPECT_EQ(calibration.scores(), (std::vector<double>{0.5, 0.8}));
  EXPECT_EQ(calibration.probabilities(), (std::vector<double>{0.25, 1}));
  // A falling run pools to its mean: three blocks become one.
  const search::Calibration falling = search::fit_calibration({1, 2, 3}, {true, false, false});
  EXPECT_EQ(falling.scores(), (std::vector<double>{1, 3}));
  EXPECT_NEAR(falling.probability(2), 1. / 3, 1e-12);
}

TEST(Calibration, NeverFallsAndKeepsTheMean) {
  std::vector<double> scores;
  std::vector<bool> right;
  double sum = 0;
  for (int i = 0; i < 500; ++i) {
    scores.push_back(std::fmod(i * 0.61803, 1.0));
    right.push_back(std::fmod(i * 0.7548, 1.0) < scores.back());
    sum += right.back() ? 1 : 0;
  }
  const search::Calibration calibration = search::fit_calibration(scores, right);
  double fitted = 0, before = 0;
  for (const double share : calibration.probabilities()) {
    EXPECT_GE(share, before);
    before = share;
  }
  for (const double score : scores) fitted += calibration.probability(score);
  EXPECT_NEAR(fitted, sum, 1e-9);  // a property of least squares
}

TEST(Calibration, JsonGoesBothWaysAndIsChecked) {
  const search::Calibration calibration =
      search::fit_calibration({0.1, 0.4, 0.2}, {false, true, true});
  const nlohmann::json json = calibration;
  const search::Calibration back = search::parse_calibration(nlohmann::json::parse(json.dump()));
  EXPECT_EQ(back.scores(), calibration.scores());
  EXPECT_EQ(back.probabilities(), calibration.probabilities());
  EXPECT_EQ(back.pairs(), 3);
  for (const char* broken : {"{}", "[]", R"({"scores":[],"probabilities":[],"pairs":0})",
                             R"({"scores":[1,0],"probabilities":[0,1],"pairs":2})",
                             R"({"scores":[0,1],"probabilities":[1,0],"pairs":2})",
                             R"({"scores":[0,1],"probabilities":[0,2],"pairs":2})",
                             R"({"scores":[0],"probabilities":[0,1],"pairs":2})"}) {
    EXPECT_THROW(search::parse_calibration(nlohmann::json::parse(broken)), Error) << broken;
  }
}

TEST(Calibration, BadPairsAreRefused) {
  EXPECT_THROW(search::fit_calibration({}, {}), Error);
  EXPECT_THROW(search::fit_calibration({0.1}, {true, false}), Error);
  EXPECT_THROW(search::fit_calibration({std::nan("")}, {true}), Error);
  EXPECT_THROW(search::Calibration().probability(0.5), Error);
}

TEST(Calibration, ExpectedErrorByHand) {
  const auto bins =
      search::reliability_bins({0.1, 0.3, 0.8, 0.9, 1}, {false, true, true, true, false}, 2);
  ASSERT_EQ(bins.size(), 2u);
  EXPECT_EQ(bins[0].count, 2);
  EXPECT_NEAR(bins[0].predicted, 0.2, 1e-12);
  EXPECT_NEAR(bins[0].right, 0.5, 1e-12);
  EXPECT_EQ(bins[1].count, 3);
  EXPECT_NEAR(bins[1].predicted, 0.9, 1e-12);
  EXPECT_NEAR(search::expected_calibration_error(bins), (2 * 0.3 + 3 * (0.9 - 2. / 3)) / 5, 1e-12);
  EXPECT_EQ(search::expected_calibration_error(search::reliability_bins({}, {}, 4)), 0);
}

}  // namespace
}  // namespace remomask
