#include "encoders/bert_encoder.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include "remomask/error.h"
#include "tests/encoders/tiny_words.h"

namespace remomask {
namespace {

encoders::TextTower& tower() { return *tiny_words()->tower(); }

TEST(TextTower, ResultDoesNotDependOnTheBatch) {
  const at::NoGradGuard no_grad;
  const std::vector<std::string> captions = {"a person walks", "waves",
                                             "a person walks forward and waves and walks again"};
  const encoders::TokenBatch together = tower().tokenize(captions);
  const encoders::TextStates all = tower().encode(together.ids, together.mask);
  for (size_t i = 0; i < captions.size(); ++i) {
    const encoders::TokenBatch alone = tower().tokenize({captions[i]});
    const encoders::TextStates one = tower().encode(alone.ids, alone.mask);
    const auto row = static_cast<int64_t>(i);
    EXPECT_TRUE(torch::allclose(one.pooled[0], all.pooled[row], 1e-4, 1e-5));
    EXPECT_TRUE(
        torch::allclose(one.states[0], all.states[row].slice(0, 0, alone.ids.size(1)), 1e-4, 1e-5));
  }
}

TEST(TextTower, EmptyAndOverlongCaptions) {
  EXPECT_THROW(tower().tokenize({"a person walks", " "}), Error);
  std::string text;
  while (text.size() < 10000) text += "walks ";
  const encoders::TokenBatch batch = tower().tokenize({text, "waves"});
  EXPECT_EQ(batch.ids.size(1), 64);
  EXPECT_GT(batch.dropped[0], 0);
  EXPECT_EQ(batch.dropped[1], 0);
}

TEST(TextTower, SpecialTokensAreThoseThatStandForNoWord) {
  const encoders::TokenBatch batch = tower().tokenize({"walks", "a person walks slowly"});
  const std::vector<int64_t> special = tower().special_ids();
  const auto count = [&](int64_t row) {
    int64_t words = 0;
    for (int64_t i = 0; i < batch.ids.size(1); ++i) {
      const auto id = batch.ids[row][i].item<int64_t>();
      words += std::find(special.begin(), special.end(), id) == special.end();
    }
    return words;
  };
  EXPECT_EQ(count(0), 1);
  EXPECT_EQ(count(1), 4);
}

TEST(TextTower, TheTailGoesOnWhereTheRestStops) {
  const encoders::TokenBatch batch = tower().tokenize({"a person walks", "waves"});
  for (int64_t layers = 0; layers <= 2; ++layers) {
    const auto tail = tower().tail(layers);
    const at::Tensor below = tower().encode_below(batch.ids, batch.mask, layers).detach();
    const at::Tensor whole = tower().encode(batch.ids, batch.mask).states.detach();
    const at::Tensor states = tail->forward(below, batch.mask);
    EXPECT_TRUE(states.equal(whole)) << layers;
    if (layers == 0) continue;
    EXPECT_EQ(tail->parameters().size(), static_cast<size_t>(16 * layers));
    states.sum().backward();
    for (const auto& parameter : tail->named_parameters()) {
      EXPECT_TRUE(parameter.value().grad().defined()) << parameter.key();
    }
    // It is a copy: what is trained here changes nothing there.
    {
      const at::NoGradGuard no_grad;
      for (at::Tensor& parameter : tail->parameters()) parameter.add_(1);
    }
    EXPECT_TRUE(tower().encode(batch.ids, batch.mask).states.equal(whole)) << layers;
  }
  EXPECT_THROW(tower().tail(3), Error);
  EXPECT_THROW(tower().encode_below(batch.ids, batch.mask, -1), Error);
}

}  // namespace
}  // namespace remomask
