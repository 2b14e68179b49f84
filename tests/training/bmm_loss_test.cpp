#include "training/bmm_loss.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include <cmath>
#include <limits>

namespace remomask {
namespace {

at::Tensor matrix(std::vector<float> values, int64_t columns) {
  return torch::tensor(values).view({-1, columns});
}

at::Tensor nothing(int64_t rows, int64_t columns) { return torch::zeros({rows, columns}); }

constexpr float kNever = -std::numeric_limits<float>::infinity();

// Queries (1,0), (0,1); keys (1,0), (0.6,0.8); scale 2.
// Logits: row 0: 2, 1.2; row 1: 0, 1.6.
const std::vector<float> kTwoQueries = {1, 0, 0, 1}, kTwoKeys = {1, 0, 0.6f, 0.8f};

TEST(ContrastLoss, BatchAloneByHand) {
  const double row0 = -2 + std::log(std::exp(2) + std::exp(1.2));
  const double row1 = -1.6 + std::log(std::exp(0) + std::exp(1.6));
  const auto loss = training::contrast_loss(matrix(kTwoQueries, 2), matrix(kTwoKeys, 2), {},
                                            nothing(2, 2), {}, torch::tensor(2.f));
  EXPECT_NEAR(loss.item<double>(), (row0 + row1) / 2, 1e-6);
}

TEST(ContrastLoss, QueueAddsNegativesByHand) {
  // Queue entry (0,1): logits 0 and 2.
  const double row0 = -2 + std::log(std::exp(2) + std::exp(1.2) + std::exp(0));
  const double row1 = -1.6 + std::log(std::exp(0) + std::exp(1.6) + std::exp(2));
  const auto loss =
      training::contrast_loss(matrix(kTwoQueries, 2), matrix(kTwoKeys, 2), matrix({0, 1}, 2),
                              nothing(2, 2), nothing(2, 1), torch::tensor(2.f));
  EXPECT_NEAR(loss.item<double>(), (row0 + row1) / 2, 1e-6);
}

TEST(ContrastLoss, MaskedNegativesDoNotCountAndTheTargetAlwaysDoes) {
  at::Tensor batch = nothing(2, 2), queue = nothing(2, 1);
  batch[0][0] = kNever;  // the diagonal is not read
  batch[1][0] = kNever;  // row 1 loses its batch negative
  queue[1][0] = kNever;  // and its queue entry: nothing is left, loss 0
  const double row0 = -2 + std::log(std::exp(2) + std::exp(1.2) + std::exp(0));
  const auto loss = training::contrast_loss(matrix(kTwoQueries, 2), matrix(kTwoKeys, 2),
                                            matrix({0, 1}, 2), batch, queue, torch::tensor(2.f));
  EXPECT_NEAR(loss.item<double>(), row0 / 2, 1e-6);
}

TEST(ContrastLoss, GradientAgreesWithDifferences) {
  torch::manual_seed(4);
  const auto options = torch::TensorOptions(torch::kDouble);
  at::Tensor queries = torch::randn({3, 4}, options), scale = torch::tensor(1.7, options);
  const at::Tensor keys = torch::randn({3, 4}, options), queue = torch::randn({5, 4}, options);
  at::Tensor batch_bias = nothing(3, 3), queue_bias = nothing(3, 5);
  batch_bias[0][2] = kNever;
  queue_bias[1][4] = kNever;
  const auto value = [&] {
    return training::contrast_loss(queries, keys, queue, batch_bias, queue_bias, scale);
  };
  queries.requires_grad_(true);
  scale.requires_grad_(true);
  value().backward();
  constexpr double kStep = 1e-6;
  at::NoGradGuard no_grad;
  const auto check = [&](at::Tensor x, const at::Tensor& gradient) {
    double* values = x.data_ptr<double>();
    for (int64_t i = 0; i < x.numel(); ++i) {
      const double kept = values[i];
      values[i] = kept + kStep;
      const double above = value().item<double>();
      values[i] = kept - kStep;
      const double below = value().item<double>();
      values[i] = kept;
      EXPECT_NEAR(gradient.view({-1})[i].item<double>(), (above - below) / (2 * kStep), 1e-7);
    }
  };
  check(queries, queries.grad());
  check(scale, scale.grad());
}

TEST(ContrastLoss, WeakNegativesWeighByHand) {
  at::Tensor batch = nothing(2, 2), queue = nothing(2, 1);
  batch[0][1] = std::log(0.25f);
  queue[1][0] = std::log(0.5f);
  const double row0 = -2 + std::log(std::exp(2) + 0.25 * std::exp(1.2) + std::exp(0));
  const double row1 = -1.6 + std::log(std::exp(0) + std::exp(1.6) + 0.5 * std::exp(2));
  const auto loss = training::contrast_loss(matrix(kTwoQueries, 2), matrix(kTwoKeys, 2),
                                            matrix({0, 1}, 2), batch, queue, torch::tensor(2.f));
  EXPECT_NEAR(loss.item<double>(), (row0 + row1) / 2, 1e-6);
}

TEST(NegativeBias, GroupAndCaptionCountNeverMeaningByItsWeight) {
  const training::PairIdentity queries{torch::tensor({1L, 2L}), torch::tensor({10L, 20L}),
                                       torch::tensor({100L, 200L})};
  const training::PairIdentity keys{torch::tensor({1L, 3L, 4L}), torch::tensor({30L, 20L, 40L}),
                                    torch::tensor({300L, 300L, 100L})};
  const float weak = std::log(0.1f);
  EXPECT_TRUE(torch::allclose(training::negative_bias(queries, keys, 0.1),
                              matrix({kNever, 0, weak, 0, kNever, 0}, 3)));
  EXPECT_TRUE(training::negative_bias(queries, keys, 0)
                  .equal(matrix({kNever, 0, kNever, 0, kNever, 0}, 3)));
  EXPECT_TRUE(
      training::negative_bias(queries, keys, 1).equal(matrix({kNever, 0, 0, 0, kNever, 0}, 3)));
}

}  // namespace
}  // namespace remomask
