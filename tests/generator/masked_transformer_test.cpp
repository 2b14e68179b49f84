#include "generator/masked_transformer.h"

#include <gtest/gtest.h>

#include "remomask/error.h"
#include "tests/generator/condition_test_tools.h"

namespace remomask {
namespace {

/// A model whose retrieval path has an effect.
generator::MaskedTransformer stirred_masked_model(const generator::MaskedConfig& config) {
  torch::manual_seed(11);
  generator::MaskedTransformer model(config);
  randomise_parameters(*model, 0.2);
  model->eval();
  return model;
}

TEST(MaskedTransformer, AloneEqualsPaddedBatch) {
  const torch::NoGradGuard no_grad;
  const generator::MaskedConfig config = small_masked_config();
  auto model = stirred_masked_model(config);
  const std::vector<int64_t> lengths = {3, 7, 5};
  auto tokens = torch::randint(config.codes + 1, {3, 7, 3}, torch::kLong);
  auto frame_mask = torch::zeros({3, 7}, torch::kBool);
  generator::Condition condition =
      with_hit_tokens(random_condition(3, 6, 2, 12, 8), 1, 5, 3, config.codes);
  condition.text_mask[1].slice(0, 2, 6).fill_(false);
  condition.hit_tokens[1].slice(1, 2, 5).fill_(-1);
  condition.hit_mask[2][1] = false;
  for (int64_t i = 0; i < 3; ++i) frame_mask[i].slice(0, 0, lengths[i]).fill_(true);
  const auto together = model->forward(tokens, model->prepare(condition), frame_mask);
  for (int64_t i = 0; i < 3; ++i) {
    generator::Condition one = generator::select_condition(condition, torch::tensor({i}));
    if (i == 1) {  // alone, its text has no padding either
      one.text_states = one.text_states.slice(1, 0, 2);
      one.text_mask = one.text_mask.slice(1, 0, 2);
      one.hit_tokens = one.hit_tokens.slice(2, 0, 2);  // nor has its hit
    }
    const auto alone =
        model->forward(tokens[i].slice(0, 0, lengths[i]).unsqueeze(0), model->prepare(one));
    const auto part = together[i].slice(0, 0, lengths[i] * 3);
    EXPECT_LT((alone[0] - part).abs().max().item<float>(), 1e-4f) << "sample " << i;
  }
}

TEST(MaskedTransformer, NullTokensReplaceWhatIsOff) {
  const torch::NoGradGuard no_grad;
  const generator::MaskedConfig config = small_masked_config();
  auto model = stirred_masked_model(config);
  const auto tokens = torch::randint(config.codes, {1, 4, 3}, torch::kLong);
  const auto logits = [&](const generator::Condition& c) {
    return model->forward(tokens, model->prepare(c));
  };
  const generator::Condition first =
      with_hit_tokens(random_condition(1, 4, 2, 12, 8), 1, 4, 3, config.codes);
  generator::Condition other_hits =
      with_hit_tokens(random_condition(1, 4, 2, 12, 8), 1, 4, 3, config.codes);
  other_hits.text_states = first.text_states;
  other_hits.text_query = first.text_query;
  generator::Condition other_text = random_condition(1, 4, 2, 12, 8);
  other_text.hit_motion = first.hit_motion;
  other_text.hit_text = first.hit_text;
  other_text.hit_similarity = first.hit_similarity;
  other_text.hit_tokens = first.hit_tokens;
  const auto differ = [&](const generator::Condition& a, const generator::Condition& b) {
    return (logits(a) - logits(b)).abs().max().item<float>();
  };
  EXPECT_GT(differ(first, other_hits), 1e-3f);
  EXPECT_GT(differ(first, other_text), 1e-3f);
  const auto without = [](generator::Condition c, bool text, bool retrieval) {
    if (text) c.use_text = torch::zeros_like(c.use_text);
    if (retrieval) c.use_retrieval = torch::zeros_like(c.use_retrieval);
    return c;
  };
  EXPECT_EQ(differ(without(first, false, true), without(other_hits, false, true)), 0.f);
  EXPECT_EQ(differ(without(first, true, false), without(other_text, true, false)), 0.f);
  EXPECT_GT(differ(without(first, true, false), first), 1e-3f);
  // Retrieval off is the same as no hit found, and as a condition without any hit row.
  generator::Condition no_hit = first;
  no_hit.hit_mask = torch::zeros_like(no_hit.hit_mask);
  EXPECT_EQ(differ(without(first, false, true), no_hit), 0.f);
  generator::Condition empty = first;
  empty.hit_motion = empty.hit_motion.slice(1, 0, 0);
  empty.hit_text = empty.hit_text.slice(1, 0, 0);
  empty.hit_similarity = empty.hit_similarity.slice(1, 0, 0);
  empty.hit_mask = empty.hit_mask.slice(1, 0, 0);
  empty.hit_tokens = empty.hit_tokens.slice(1, 0, 0);
  EXPECT_LT(differ(no_hit, empty), 1e-4f);
}

TEST(MaskedTransformer, HitsAsSequencesAreReadCodeByCode) {
  const torch::NoGradGuard no_grad;
  const generator::MaskedConfig config = small_masked_config();
  auto model = stirred_masked_model(config);
  const auto tokens = torch::randint(config.codes, {1, 4, 3}, torch::kLong);
  const auto logits = [&](const generator::Condition& c) {
    return model->forward(tokens, model->prepare(c));
  };
  const auto differ = [&](const generator::Condition& a, const generator::Condition& b) {
    return (logits(a) - logits(b)).abs().max().item<float>();
  };
  const generator::Condition first =
      with_hit_tokens(random_condition(1, 4, 2, 12, 8), 1, 5, 3, config.codes);
  const auto with_tokens = [&](const at::Tensor& map) {
    generator::Condition condition = first;
    condition.hit_tokens = map;
    return condition;
  };
  // Every code counts, the last one of an odd number of frames as well, and so do order and part.
  for (const int64_t frame : {0, 1, 4}) {
    at::Tensor map = first.hit_tokens.clone();
    map[0][0][frame][2] = (map[0][0][frame][2] + 1) % config.codes;
    EXPECT_GT(differ(first, with_tokens(map)), 1e-5f) << frame;
  }
  EXPECT_GT(differ(first, with_tokens(first.hit_tokens.flip(2))), 1e-5f);
  EXPECT_GT(differ(first, with_tokens(first.hit_tokens.flip(3))), 1e-5f);
  // Frames that do not exist count for nothing; nor do hits beyond sequence_hits.
  EXPECT_LT(differ(first, with_tokens(torch::constant_pad_nd(first.hit_tokens, {0, 0, 0, 3}, -1))),
            1e-5f);
  const auto two = torch::cat({first.hit_tokens, first.hit_tokens.flip(2)}, 1);
  EXPECT_EQ(differ(first, with_tokens(two)), 0.f);
  // Nor does a hit that search did not find.
  generator::Condition hidden = first, other = with_tokens(first.hit_tokens.flip(2));
  hidden.hit_mask = other.hit_mask = torch::zeros_like(first.hit_mask);
  EXPECT_EQ(differ(hidden, other), 0.f);

  generator::MaskedConfig greedy = config;
  greedy.sequence_hits = greedy.max_hits + 1;
  EXPECT_EQ(generator::MaskedTransformer(greedy)->config().sequence_hits, greedy.max_hits);
}

TEST(MaskedTransformer, FilesOfBeforeSequenceHitsLoad) {
  generator::MaskedConfig config = small_masked_config();
  config.sequence_hits = 0;
  nn::ModelStage stage = generator::masked_stage(stirred_masked_model(config));
  stage.config.erase("sequence_hits");
  EXPECT_EQ(generator::load_masked(stage)->config().sequence_hits, 0);
}

TEST(MaskedTransformer, OneRowWithoutRetrievalWorks) {
  generator::MaskedConfig config = small_masked_config();
  config.rows = 1;
  config.max_hits = 0;
  auto model = stirred_masked_model(config);
  const auto out = model->forward(torch::zeros({2, 5, 1}, torch::kLong),
                                  model->prepare(random_condition(2, 3, 0, 12, 8)));
  EXPECT_EQ(out.sizes(), (std::vector<int64_t>{2, 5, 16}));
}

TEST(MaskedTransformer, SaveAndLoadAreExact) {
  auto model = stirred_masked_model(small_masked_config());
  auto loaded = generator::load_masked(generator::masked_stage(model));
  const auto tokens = torch::randint(16, {1, 4, 3}, torch::kLong);
  const generator::Condition condition =
      with_hit_tokens(random_condition(1, 4, 2, 12, 8), 1, 4, 3, /*codes=*/16);
  EXPECT_TRUE(torch::equal(model->forward(tokens, model->prepare(condition)),
                           loaded->forward(tokens, loaded->prepare(condition))));
  nn::ModelStage stage = generator::masked_stage(model);
  stage.kind = "tokenizer";
  EXPECT_THROW(generator::load_masked(stage), Error);
}

}  // namespace
}  // namespace remomask
