#include "generator/ssta.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "generator/biased_attention.h"
#include "tests/generator/condition_test_tools.h"

namespace remomask {
namespace {

using Matrix = std::vector<std::vector<double>>;

double dot_part(const std::vector<double>& a, const std::vector<double>& b, int64_t first,
                int64_t last) {
  double sum = 0;
  for (int64_t i = first; i < last; ++i) sum += a[i] * b[i];
  return sum;
}

Matrix to_matrix(const at::Tensor& x) {
  Matrix matrix(x.size(0), std::vector<double>(x.size(1)));
  for (int64_t i = 0; i < x.size(0); ++i) {
    for (int64_t j = 0; j < x.size(1); ++j) matrix[i][j] = x[i][j].item<double>();
  }
  return matrix;
}

/// Attention of two tokens over tokens and condition rows, written as loops.
Matrix attend_by_loops(const Matrix& q, const Matrix& k, const Matrix& v, const Matrix& bias,
                       int64_t heads) {
  const int64_t width = static_cast<int64_t>(q[0].size()), head_width = width / heads;
  Matrix out(q.size(), std::vector<double>(width, 0));
  for (size_t i = 0; i < q.size(); ++i) {
    for (int64_t h = 0; h < heads; ++h) {
      std::vector<double> weight(k.size());
      double sum = 0;
      for (size_t j = 0; j < k.size(); ++j) {
        const double logit =
            dot_part(q[i], k[j], h * head_width, (h + 1) * head_width) / std::sqrt(head_width);
        weight[j] = std::exp(logit + bias[i][j]);
        sum += weight[j];
      }
      for (size_t j = 0; j < k.size(); ++j) {
        for (int64_t c = h * head_width; c < (h + 1) * head_width; ++c) {
          out[i][c] += weight[j] / sum * v[j][c];
        }
      }
    }
  }
  return out;
}

generator::SstaConfig two_token_config() {
  generator::SstaConfig config;
  config.rows = 1;
  config.width = 4;
  config.heads = 2;
  config.hidden = 8;
  config.dropout = 0;
  config.text_width = 4;
  config.embedding_width = 2;
  return config;
}

TEST(Ssta, EqualsLoopsForTwoTokensOneTextOneHit) {
  generator::Ssta ssta(two_token_config());
  ssta->to(torch::kDouble);
  auto parameters = ssta->named_parameters();
  {
    const torch::NoGradGuard no_grad;
    for (auto& item : parameters) item.value().zero_();
    const auto eye = torch::eye(4, torch::kDouble);
    parameters["query_key_value.weight"].copy_(eye.repeat({3, 1}));
    parameters["text_key_value.weight"].copy_(eye.repeat({2, 1}));
    parameters["output.weight"].copy_(eye);
    // Key of the hit: (R_m[0], R_m[1], R_t[0], R_t[1] + s); value: R_m twice.
    auto& key = parameters["hit_key.weight"];
    for (int i = 0; i < 4; ++i) key[i][i] = 1;
    key[3][4] = 1;
    auto& value = parameters["hit_value.weight"];
    for (int i = 0; i < 4; ++i) value[i][i % 2] = 1;
    // dt = -1, 0, 1 (entries 47, 48, 49): one bias for both heads.
    parameters["position_bias.weight"][47].fill_(0.5);
    parameters["position_bias.weight"][48].fill_(-0.25);
    parameters["position_bias.weight"][49].fill_(0.75);
    parameters["kind_bias.weight"][0].fill_(0.1);
    parameters["kind_bias.weight"][2].fill_(-0.3);
  }
  const auto z = torch::tensor({0.5, -1.0, 0.25, 2.0, 1.0, 0.0, -0.5, 0.75}, torch::kDouble)
                     .reshape({1, 2, 4});
  const auto text = torch::tensor({0.3, 0.6, -0.9, 0.2}, torch::kDouble);
  generator::ConditionRows rows;
  rows.text = text.reshape({1, 1, 4});
  rows.hit_keys = torch::tensor({0.4, -0.2, 0.7, 0.1, 0.9}, torch::kDouble).reshape({1, 1, 5});
  rows.hit_values = torch::tensor({0.4, -0.2}, torch::kDouble).reshape({1, 1, 2});
  rows.visible = torch::ones({1, 2}, torch::kBool);
  rows.kinds = torch::tensor({0, 2}, torch::kLong);

  const Matrix tokens = to_matrix(z[0]);
  const Matrix keys = {tokens[0], tokens[1], {0.3, 0.6, -0.9, 0.2}, {0.4, -0.2, 0.7, 1.0}};
  const Matrix values = {tokens[0], tokens[1], {0.3, 0.6, -0.9, 0.2}, {0.4, -0.2, 0.4, -0.2}};
  const Matrix bias = {{-0.25, 0.75, 0.1, -0.3}, {0.5, -0.25, 0.1, -0.3}};
  const Matrix expected = attend_by_loops(tokens, keys, values, bias, 2);

  const auto out =
      ssta->forward(z, ssta->prepare(rows), generator::relative_position_index(2, 1), {});
  for (int i = 0; i < 2; ++i) {
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(out[0][i][c].item<double>(), expected[i][c], 1e-12);
  }
}

TEST(Ssta, RelativeIndexCountsDistanceAndRows) {
  const auto index = generator::relative_position_index(3, 2).reshape({6, 6});
  // Token 1 = (t 0, row 1), token 4 = (t 2, row 0): dt = 2.
  EXPECT_EQ(index[1][4].item<int64_t>(), ((2 + 48) * 2 + 1) * 2 + 0);
  EXPECT_EQ(index[4][1].item<int64_t>(), ((-2 + 48) * 2 + 0) * 2 + 1);
  EXPECT_EQ(index[3][3].item<int64_t>(), (48 * 2 + 1) * 2 + 1);
  const auto longer = generator::relative_position_index(60, 1).reshape({60, 60});
  EXPECT_EQ(longer[0][59].item<int64_t>(), 96);
  EXPECT_EQ(longer[59][0].item<int64_t>(), 0);
}

TEST(Ssta, AnalyticGradientEqualsDifferences) {
  torch::manual_seed(5);
  generator::SstaConfig config = two_token_config();
  config.rows = 2;
  generator::Ssta ssta(config);
  ssta->to(torch::kDouble);
  randomise_parameters(*ssta, 0.7);
  generator::ConditionRows rows;
  rows.text = torch::randn({2, 2, 4}, torch::kDouble);
  rows.hit_keys = torch::randn({2, 2, 5}, torch::kDouble);
  rows.hit_values = torch::randn({2, 2, 2}, torch::kDouble);
  rows.visible = torch::tensor({1, 1, 1, 0, 0, 1, 0, 1}, torch::kBool).reshape({2, 4});
  rows.kinds = torch::tensor({0, 1, 2, 2}, torch::kLong);
  auto z = torch::randn({2, 4, 4}, torch::kDouble);
  const auto token_mask = torch::tensor({1, 1, 1, 1, 1, 1, 0, 0}, torch::kBool).reshape({2, 4});
  const auto weight = torch::randn({2, 4, 4}, torch::kDouble);
  const auto index = generator::relative_position_index(2, 2);
  const auto objective = [&] {
    return (ssta->forward(z, ssta->prepare(rows), index, token_mask) * weight).sum();
  };
  z.requires_grad_();
  rows.text.requires_grad_();
  rows.hit_keys.requires_grad_();
  rows.hit_values.requires_grad_();
  objective().backward();
  std::map<std::string, at::Tensor> checked = {
      {"z", z}, {"text", rows.text}, {"hit_keys", rows.hit_keys}, {"hit_values", rows.hit_values}};
  for (auto& item : ssta->named_parameters()) checked[item.key()] = item.value();
  for (auto& [name, tensor] : checked) {
    const auto gradient = tensor.grad().reshape({-1});
    const torch::NoGradGuard no_grad;
    auto flat = tensor.view({-1});
    // Every entry of small tensors, about twenty of large ones.
    const int64_t stride = std::max<int64_t>(1, flat.size(0) / 20);
    for (int64_t i = name == "position_bias.weight" ? flat.size(0) / 2 - 12 : 0, n = 0;
         i < flat.size(0) && n < 24; i += name == "position_bias.weight" ? 1 : stride, ++n) {
      const double kept = flat[i].item<double>(), step = 1e-5;
      flat[i] = kept + step;
      const double up = objective().item<double>();
      flat[i] = kept - step;
      const double down = objective().item<double>();
      flat[i] = kept;
      EXPECT_NEAR(gradient[i].item<double>(), (up - down) / (2 * step), 1e-7)
          << name << " entry " << i;
    }
  }
}

TEST(Ssta, RetrievalStartsWithoutInfluenceThroughValues) {
  torch::manual_seed(6);
  generator::SstaConfig config = two_token_config();
  generator::SstaStack stack(config, 2);
  stack->initialise();
  for (auto& item : stack->named_parameters()) {
    if (item.key().find("hit_value.") != std::string::npos) {
      EXPECT_EQ(item.value().abs().max().item<float>(), 0) << item.key();
    }
  }
  generator::SstaConfig text_only = config;
  text_only.retrieval = false;
  for (auto& item : generator::SstaStack(text_only, 2)->named_parameters()) {
    EXPECT_EQ(item.key().find("hit_"), std::string::npos) << item.key();
  }
}

TEST(Ssta, TokensStayDistinctAtInitialisation) {
  torch::manual_seed(7);
  generator::MaskedConfig config;
  config.layers = 6;
  generator::MaskedTransformer model(config);
  model->eval();
  const auto tokens = torch::randint(config.codes, {2, 12, 6}, torch::kLong);
  std::vector<at::Tensor> stream;
  model->forward(tokens, model->prepare(random_condition(2, 5, 3, 256, 256)), {}, &stream);
  ASSERT_EQ(stream.size(), 6u);
  for (size_t i = 0; i < stream.size(); ++i) {
    EXPECT_GT(token_energy(stream[i]), 1e-2) << "after block " << i;
  }
}

TEST(Ssta, WidthMustFitTheHeads) {
  generator::SstaConfig config = two_token_config();
  config.heads = 3;
  EXPECT_ANY_THROW(generator::SstaStack(config, 1));
}

}  // namespace
}  // namespace remomask
