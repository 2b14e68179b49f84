#include "generator/residual_transformer.h"

#include <gtest/gtest.h>

#include "remomask/error.h"
#include "tests/generator/condition_test_tools.h"

namespace remomask {
namespace {

generator::ResidualTransformer stirred_residual_model() {
  torch::manual_seed(21);
  generator::ResidualTransformer model(small_residual_config());
  randomise_parameters(*model, 0.2);
  model->eval();
  return model;
}

TEST(ResidualTransformer, TablesAreSharedBetweenInputAndOutput) {
  auto model = stirred_residual_model();
  const auto tables = model->named_parameters()["tables"];
  EXPECT_EQ(tables.sizes(), (std::vector<int64_t>{4, 3, 16, 32}));
  const auto tokens = torch::randint(16, {1, 5, 3, 4}, torch::kLong);
  const auto caches = model->prepare(random_condition(1, 4, 0, 12, 8));
  const auto influenced = [&](int64_t table, int64_t level) {
    const torch::NoGradGuard no_grad;
    const auto target = torch::full({1}, level, torch::kLong);
    const auto before = model->forward(tokens, target, caches);
    const auto kept = tables[table].clone();
    tables[table] += 0.1 * torch::randn_like(kept);
    const auto after = model->forward(tokens, target, caches);
    tables[table] = kept;
    return !torch::equal(before, after);
  };
  // Level l reads tables 0 .. l-1 as embeddings and table l as projection.
  for (int64_t level = 1; level < 4; ++level) {
    for (int64_t table = 0; table < 4; ++table) {
      EXPECT_EQ(influenced(table, level), table <= level) << "level " << level << " " << table;
    }
  }
}

TEST(ResidualTransformer, LevelsInOneBatchDoNotMix) {
  const torch::NoGradGuard no_grad;
  auto model = stirred_residual_model();
  const auto tokens = torch::randint(16, {5, 6, 3, 4}, torch::kLong);
  const auto levels = torch::tensor({3, 1, 2, 1, 3}, torch::kLong);
  const generator::Condition condition = random_condition(5, 4, 0, 12, 8);
  auto frame_mask = torch::ones({5, 6}, torch::kBool);
  frame_mask[1].slice(0, 4, 6).fill_(false);
  const auto together = model->forward(tokens, levels, model->prepare(condition), frame_mask);
  for (int64_t i = 0; i < 5; ++i) {
    const int64_t length = i == 1 ? 4 : 6;
    const auto one = generator::select_condition(condition, torch::tensor({i}));
    const auto alone = model->forward(tokens[i].slice(0, 0, length).unsqueeze(0),
                                      levels.slice(0, i, i + 1), model->prepare(one));
    EXPECT_LT((alone[0] - together[i].slice(0, 0, length * 3)).abs().max().item<float>(), 1e-4f);
  }
}

TEST(ResidualTransformer, TokensOfTheLevelAndAboveAreNotRead) {
  const torch::NoGradGuard no_grad;
  auto model = stirred_residual_model();
  const auto tokens = torch::randint(16, {1, 6, 3, 4}, torch::kLong);
  const auto caches = model->prepare(random_condition(1, 4, 0, 12, 8));
  const auto level = torch::full({1}, 2, torch::kLong);
  auto changed = tokens.clone();
  changed.slice(3, 2, 4).copy_((tokens.slice(3, 2, 4) + 5) % 16);
  EXPECT_TRUE(
      torch::equal(model->forward(tokens, level, caches), model->forward(changed, level, caches)));
  changed.select(3, 1).copy_((tokens.select(3, 1) + 5) % 16);
  EXPECT_FALSE(
      torch::equal(model->forward(tokens, level, caches), model->forward(changed, level, caches)));
}

TEST(ResidualTransformer, TokensStayDistinctAtInitialisation) {
  torch::manual_seed(22);
  generator::ResidualTransformer model((generator::ResidualConfig()));
  model->eval();
  std::vector<at::Tensor> stream;
  model->forward(torch::randint(256, {2, 8, 6, 6}, torch::kLong),
                 torch::tensor({1, 4}, torch::kLong),
                 model->prepare(random_condition(2, 5, 0, 256, 256)), {}, &stream);
  for (const auto& x : stream) EXPECT_GT(token_energy(x), 1e-2);
}

TEST(ResidualTransformer, SaveAndLoadAreExact) {
  auto model = stirred_residual_model();
  auto loaded = generator::load_residual(generator::residual_stage(model));
  const auto tokens = torch::randint(16, {2, 4, 3, 4}, torch::kLong);
  const auto level = torch::tensor({1, 3}, torch::kLong);
  const generator::Condition condition = random_condition(2, 4, 0, 12, 8);
  EXPECT_TRUE(torch::equal(model->forward(tokens, level, model->prepare(condition)),
                           loaded->forward(tokens, level, loaded->prepare(condition))));
  nn::ModelStage stage = generator::residual_stage(model);
  stage.tensors.erase("tables");
  EXPECT_THROW(generator::load_residual(stage), Error);
}

}  // namespace
}  // namespace remomask
