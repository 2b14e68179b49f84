#include "nn/layers.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

#include <cmath>

namespace remomask {
namespace {

TEST(SinusoidalPositionsTest, FirstValues) {
  const auto table = nn::sinusoidal_positions(3, 4);
  EXPECT_FLOAT_EQ(table[0][0].item<float>(), 0.f);
  EXPECT_FLOAT_EQ(table[0][1].item<float>(), 1.f);
  EXPECT_NEAR(table[2][0].item<float>(), std::sin(2.0), 1e-6);
  EXPECT_NEAR(table[2][3].item<float>(), std::cos(2.0 / 100), 1e-6);
}

TEST(MultiHeadAttentionTest, MatchesAnExplicitLoop) {
  torch::manual_seed(1);
  const int64_t batch = 2, n = 3, m = 4, width = 6, heads = 2, d = width / heads;
  const auto q = torch::randn({batch, n, width}), k = torch::randn({batch, m, width});
  const auto v = torch::randn({batch, m, width}), bias = torch::randn({batch, heads, n, m});
  const auto out = nn::multi_head_attention(q, k, v, bias, heads);
  for (int64_t b = 0; b < batch; ++b) {
    for (int64_t h = 0; h < heads; ++h) {
      for (int64_t i = 0; i < n; ++i) {
        std::vector<double> weight(m);
        double sum = 0;
        for (int64_t j = 0; j < m; ++j) {
          double dot = 0;
          for (int64_t c = h * d; c < (h + 1) * d; ++c) {
            dot += q[b][i][c].item<double>() * k[b][j][c].item<double>();
          }
          weight[j] = std::exp(dot / std::sqrt(double(d)) + bias[b][h][i][j].item<double>());
          sum += weight[j];
        }
        for (int64_t c = h * d; c < (h + 1) * d; ++c) {
          double expected = 0;
          for (int64_t j = 0; j < m; ++j) expected += weight[j] / sum * v[b][j][c].item<double>();
          EXPECT_NEAR(out[b][i][c].item<double>(), expected, 1e-5);
        }
      }
    }
  }
}

TEST(EncoderStackTest, AloneEqualsPaddedBatch) {
  torch::manual_seed(2);
  nn::EncoderStack stack(2, 16, 4, 32, 0.1);
  stack->eval();
  torch::NoGradGuard no_grad;
  const auto shorter = torch::randn({1, 3, 16}), longer = torch::randn({1, 7, 16});
  const auto padded = torch::cat({shorter, torch::randn({1, 4, 16})}, 1);
  const auto mask = torch::arange(7).unsqueeze(0) < torch::tensor({{3}, {7}});
  const auto together = stack(torch::cat({padded, longer}), mask);
  const auto alone = stack(shorter, torch::ones({1, 3}, torch::kBool));
  EXPECT_LT((together[0].slice(0, 0, 3) - alone[0]).abs().max().item<float>(), 1e-5);
}

// Share of the energy that differs between the tokens of a clip; it must not
// vanish through the blocks (the official attention loses all of it).
TEST(EncoderStackTest, KeepsTokensApartAtInitialisation) {
  torch::manual_seed(3);
  nn::EncoderBlock block(64, 4, 128, 0.0);
  nn::initialise_transformer_weights(*block);
  torch::NoGradGuard no_grad;
  auto x = torch::randn({2, 40, 64});
  for (int layer = 0; layer < 8; ++layer) {
    x = block(x, torch::Tensor());
    const auto spread = (x - x.mean(1, true)).pow(2).mean() / x.pow(2).mean();
    EXPECT_GT(spread.item<float>(), 1e-2);
  }
}

TEST(EncoderBlockTest, GradientsMatchFiniteDifferences) {
  torch::manual_seed(4);
  nn::EncoderBlock block(8, 2, 12, 0.0);
  block->to(torch::kDouble);
  auto x = torch::randn({1, 3, 8}, torch::kDouble).requires_grad_(true);
  const auto weight = torch::randn({1, 3, 8}, torch::kDouble);
  const auto value = [&](const torch::Tensor& input) {
    return (block(input, torch::Tensor()) * weight).sum();
  };
  value(x).backward();
  for (const auto& [i, j] : {std::pair{0, 0}, {1, 3}, {2, 7}}) {
    torch::NoGradGuard no_grad;
    constexpr double kStep = 1e-6;
    auto up = x.detach().clone(), down = x.detach().clone();
    up[0][i][j] += kStep;
    down[0][i][j] -= kStep;
    const double numeric = (value(up) - value(down)).item().toDouble() / (2 * kStep);
    EXPECT_NEAR(x.grad()[0][i][j].item<double>(), numeric, 1e-6 * (1 + std::abs(numeric)));
  }
}

}  // namespace
}  // namespace remomask
