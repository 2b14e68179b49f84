#include "training/gate_measurement.h"

#include <gtest/gtest.h>

#include "remomask/error.h"

namespace remomask {
namespace {

TEST(EvidenceGate, ItsLimitsAreQuantiles) {
  std::vector<training::WeightedSimilarity> right, wrong;
  for (int i = 1; i <= 100; ++i) {
    right.push_back({0.5 + 0.004 * i, 2});    // the 5th of 100: 0.52
    wrong.push_back({0.604 - 0.004 * i, 2});  // the 50th from below: 0.4
  }
  const pipeline::SimilarityGate gate = training::fit_gate(right, wrong);
  EXPECT_NEAR(gate.none, 0.4, 1e-9);
  EXPECT_NEAR(gate.all, 0.52, 1e-9);
  EXPECT_NEAR(gate.trust(0.4), 0, 1e-9);
  EXPECT_NEAR(gate.trust(0.46), 0.5, 1e-9);
  EXPECT_EQ(gate.trust(0.52), 1);
  EXPECT_EQ(gate.trust(-1), 0);
  EXPECT_EQ(gate.trust(1), 1);
}

TEST(EvidenceGate, WhereRightAndWrongAreAlikeItIsAThreshold) {
  const pipeline::SimilarityGate gate =
      training::fit_gate({{0.3, 1}, {0.9, 1}}, {{0.6, 1}, {0.7, 1}});
  EXPECT_EQ(gate.none, 0.3);
  EXPECT_EQ(gate.all, 0.3);
  EXPECT_EQ(gate.trust(0.29), 0);
  EXPECT_EQ(gate.trust(0.31), 1);
}

TEST(EvidenceGate, WeightsCount) {
  // The lowest twentieth of a weight of 100 ends in the heavy hit, of 80 before it.
  std::vector<training::WeightedSimilarity> right = {{0.7, 96}};
  for (int i = 0; i < 4; ++i) right.push_back({0.1 + 0.1 * i, 1});
  EXPECT_EQ(training::fit_gate(right, {{0.05, 1}}).all, 0.7);
  right[0].weight = 76;
  EXPECT_EQ(training::fit_gate(right, {{0.05, 1}}).all, 0.4);
}

TEST(EvidenceGate, TheBetterOfTwoSimilaritiesCounts) {
  const pipeline::EvidenceGate gate{{0.4, 0.6}, {0.8, 0.9}};
  EXPECT_EQ(gate.trust(0.3, 0.7), 0);
  EXPECT_NEAR(gate.trust(0.5, 0.7), 0.5, 1e-9);
  EXPECT_EQ(gate.trust(0.5, 0.95), 1);
  EXPECT_EQ(gate.trust(0.7, -1), 1);
}

TEST(EvidenceGate, NeedsBothKinds) {
  EXPECT_THROW(training::fit_gate({}, {{0.1, 1}}), Error);
  EXPECT_THROW(training::fit_gate({{0.1, 1}}, {}), Error);
}

}  // namespace
}  // namespace remomask
