#include "training/momentum.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include "tests/encoders/tiny_words.h"
#include "tests/retriever/retriever_test_tools.h"

namespace remomask {
namespace {

training::PairBatch batch_of(const std::vector<db::TrainingClip>& clips,
                             retriever::RetrieverModel& model) {
  std::vector<std::string> captions;
  std::vector<retriever::MotionCrop> crops;
  std::vector<int64_t> groups;
  for (const db::TrainingClip& clip : clips) {
    captions.push_back(clip.captions.front());
    crops.push_back(retriever::whole_clip(clip.features));
    groups.push_back(clip.group);
  }
  const retriever::PatchBatch patches = model.motion_encoder().patches(crops);
  const encoders::TokenBatch tokens = model.text_tower().tokenize(captions);
  return {tokens,
          model.frozen_states(tokens.ids, tokens.mask),
          patches,
          patches,
          {torch::tensor(groups), torch::tensor(groups), torch::tensor(groups)}};
}

training::PairIdentity numbers(int64_t first, int64_t count) {
  const auto values = torch::arange(first, first + count, torch::kLong);
  return {values, values + 100, values + 200};
}

TEST(KeyQueue, WrapsAroundAndCountsOnlyWhatWasPushed) {
  training::KeyQueue queue(4, 1);
  EXPECT_EQ(queue.filled(), 0);
  queue.push(torch::tensor({{1.f}, {2.f}, {3.f}}), numbers(1, 3));
  EXPECT_EQ(queue.filled(), 3);
  EXPECT_TRUE(queue.keys().equal(torch::tensor({{1.f}, {2.f}, {3.f}})));
  queue.push(torch::tensor({{4.f}, {5.f}, {6.f}}), numbers(4, 3));
  EXPECT_TRUE(queue.keys().equal(torch::tensor({{5.f}, {6.f}, {3.f}, {4.f}})));
  EXPECT_TRUE(queue.identity().group.equal(torch::tensor({5L, 6L, 3L, 4L})));
  EXPECT_TRUE(queue.identity().caption.equal(torch::tensor({105L, 106L, 103L, 104L})));
  EXPECT_TRUE(queue.identity().meaning.equal(torch::tensor({205L, 206L, 203L, 204L})));
}

TEST(KeyQueue, MoreKeysThanEntriesKeepTheLast) {
  training::KeyQueue queue(2, 1);
  queue.push(torch::tensor({{1.f}, {2.f}, {3.f}, {4.f}, {5.f}}), numbers(1, 5));
  EXPECT_TRUE(queue.keys().equal(torch::tensor({{5.f}, {4.f}})));
}

TEST(Momentum, TwinFollowsByHand) {
  torch::nn::Linear twin(1, 1), online(1, 1);
  at::NoGradGuard no_grad;
  twin->weight.fill_(1);
  online->weight.fill_(3);
  training::update_twin(*twin, *online, 0.9);
  EXPECT_NEAR(twin->weight.item<double>(), 1.2, 1e-6);
  training::update_twin(*twin, *online, 0.9);
  EXPECT_NEAR(twin->weight.item<double>(), 1.38, 1e-6);
}

TEST(Bmm, KeysHaveNoDropoutNoGradientAndMoveAfterTheStep) {
  torch::manual_seed(1);
  retriever::RetrieverConfig config = tiny_retriever_config();
  config.dropout = 0.5;
  training::BmmModel model(config, tiny_words()->tower(), retriever::Queues::both, 8, 0.5, 0.07, 1);
  model.train();
  const auto clips = separable_clips(3, 1, 1);
  const training::PairBatch batch = batch_of(clips, model.online());
  const auto first = model.keys(batch), second = model.keys(batch);
  EXPECT_TRUE(first.first.equal(second.first));
  EXPECT_TRUE(first.second.equal(second.second));
  EXPECT_FALSE(first.first.requires_grad());
  // The online model has dropout in training.
  const auto one = model.online().motion_encoder().forward(batch.online_patches).global;
  const auto two = model.online().motion_encoder().forward(batch.online_patches).global;
  EXPECT_FALSE(one.equal(two));

  const training::BmmLosses losses = model.loss(batch, 0.25, 0.1);
  losses.total.backward();
  for (const auto& value : model.twin().parameters()) EXPECT_FALSE(value.grad().defined());
  for (const auto& item : model.online().named_parameters()) {
    EXPECT_TRUE(item.value().grad().defined()) << item.key();
  }
  EXPECT_EQ(model.text_queue().filled(), 0);
  model.after_step();
  EXPECT_EQ(model.text_queue().filled(), 3);
  EXPECT_TRUE(model.text_queue().keys().equal(first.first));
  EXPECT_TRUE(model.motion_queue().keys().equal(first.second));
}

TEST(Bmm, LossIsTheMeanOfBothDirectionsWithEachItsQueue) {
  torch::manual_seed(2);
  const auto clips = separable_clips(6, 1, 1);
  const std::vector<db::TrainingClip> older(clips.begin(), clips.begin() + 3),
      newer(clips.begin() + 2, clips.end());
  for (const retriever::Queues queues : {retriever::Queues::none, retriever::Queues::motion,
                                         retriever::Queues::text, retriever::Queues::both}) {
    training::BmmModel model(tiny_retriever_config(), tiny_words()->tower(), queues, 8, 1.0, 0.1,
                             1);
    model.eval();
    model.loss(batch_of(older, model.online()), 0, 0);
    model.after_step();
    const training::PairBatch batch = batch_of(newer, model.online());
    const auto [text, motion] = model.keys(batch);  // twin and online are equal still
    const auto bias = training::negative_bias(batch.identity, batch.identity, 1);
    const auto expected = [&](const at::Tensor& queries, const at::Tensor& keys,
                              const training::KeyQueue& queue, bool used) {
      if (!used) return training::contrast_loss(queries, keys, {}, bias, {}, model.scale());
      const auto stale = training::negative_bias(batch.identity, queue.identity(), 1);
      EXPECT_EQ(stale.isinf().sum().item<int64_t>(), 1);  // clip 2 meets itself
      return training::contrast_loss(queries, keys, queue.keys(), bias, stale, model.scale());
    };
    const bool with_text = queues == retriever::Queues::text || queues == retriever::Queues::both;
    const bool with_motion =
        queues == retriever::Queues::motion || queues == retriever::Queues::both;
    const double m2t = expected(motion, text, model.text_queue(), with_text).item<double>();
    const double t2m = expected(text, motion, model.motion_queue(), with_motion).item<double>();
    const training::BmmLosses losses = model.loss(batch, 0, 0);
    EXPECT_NEAR(losses.motion_to_text, m2t, 1e-5) << retriever::queues_name(queues);
    EXPECT_NEAR(losses.text_to_motion, t2m, 1e-5) << retriever::queues_name(queues);
    EXPECT_NEAR(losses.total.item<double>(), (m2t + t2m) / 2, 1e-5);
  }
}

}  // namespace
}  // namespace remomask
