#include "retriever/evidence_gate.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace remomask {
namespace {

TEST(EvidenceGate, ItsLimitsAreQuantiles) {
  std::vector<double> right, wrong;
  for (int i = 0; i <= 100; ++i) {
    right.push_back(0.5 + 0.004 * i);  // 0.5 to 0.9, 5 % quantile 0.52
    wrong.push_back(0.8 - 0.004 * i);  // 0.4 to 0.8, 95 % quantile 0.78
  }
  const EvidenceGate gate = fit_gate(right, wrong);
  EXPECT_NEAR(gate.none, 0.52, 1e-9);
  EXPECT_NEAR(gate.all, 0.78, 1e-9);
  EXPECT_EQ(gate.trust(0.52), 0);
  EXPECT_NEAR(gate.trust(0.65), 0.5, 1e-9);
  EXPECT_EQ(gate.trust(0.78), 1);
  EXPECT_EQ(gate.trust(-1), 0);
  EXPECT_EQ(gate.trust(1), 1);
}

TEST(EvidenceGate, SeparatedHitsHaveAThreshold) {
  const EvidenceGate gate = fit_gate({0.8, 0.9}, {0.2, 0.4});
  EXPECT_EQ(gate.none, gate.all);
  // Between 0.805, the 5 % quantile of the right ones, and 0.39.
  EXPECT_NEAR(gate.all, 0.5975, 1e-9);
  EXPECT_EQ(gate.trust(0.59), 0);
  EXPECT_EQ(gate.trust(0.6), 1);
}

TEST(EvidenceGate, NeedsBothKinds) {
  EXPECT_THROW(fit_gate({}, {0.1}), Error);
  EXPECT_THROW(fit_gate({0.1}, {}), Error);
}

}  // namespace
}  // namespace remomask
