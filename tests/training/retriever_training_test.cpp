#include "training/retriever_training.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include <filesystem>
#include <set>

#include "evaluation/retrieval_metrics.h"
#include "remomask/error.h"
#include "tests/retriever/retriever_test_tools.h"
#include "training/masked_words.h"
#include "training/training_batches.h"

namespace remomask {
namespace {

training::RetrieverTrainingOptions quick_options(int64_t steps) {
  training::RetrieverTrainingOptions options(ModelSize::tiny);
  options.trainer.steps = steps;
  options.batch = 16;
  options.queue_size = 24;
  return options;
}

TEST(EpochBatches, NoGroupTwiceAndEveryClipOnce) {
  auto clips = separable_clips(8, 4, 1);
  for (size_t i = 0; i < clips.size(); ++i) clips[i].group = static_cast<int>(i / 2);
  const auto batches = training::epoch_batches(clips, 8, 1, 0);
  ASSERT_EQ(batches.size(), 4u);
  std::set<size_t> seen;
  size_t repeated = 0;
  for (const auto& batch : batches) {
    ASSERT_EQ(batch.size(), 8u);
    std::set<int> groups;
    for (const size_t index : batch) {
      seen.insert(index);
      groups.insert(clips[index].group);
    }
    repeated += batch.size() - groups.size();
  }
  EXPECT_EQ(seen.size(), 32u);
  EXPECT_LE(repeated, 4u);  // only where the last batch has nothing else
  EXPECT_EQ(training::epoch_batches(clips, 8, 1, 0), batches);
  EXPECT_NE(training::epoch_batches(clips, 8, 1, 1), batches);
  EXPECT_EQ(training::epoch_batches(clips, 100, 1, 0).size(), 1u);
}

TEST(RetrieverTraining, ResumedRunEqualsTheUninterrupted) {
  const auto clips = separable_clips(12, 3, 1);
  const std::string path = testing::TempDir() + "/retriever_checkpoint.safetensors";
  std::filesystem::remove(path);
  training::RetrieverTrainingOptions options = quick_options(6);
  const retriever::RetrieverConfig config = retriever::retriever_preset(ModelSize::tiny);
  const nn::ModelStage whole = training::train_retriever(clips, clips, {}, config, options, {});

  options.trainer.checkpoint_path = path;
  options.trainer.checkpoint_seconds = 0;
  std::stop_source stop;
  Monitor monitor;
  monitor.stop = stop.get_token();
  monitor.progress = [&](const Progress& progress) {
    if (progress.done >= 1) stop.request_stop();
  };
  EXPECT_THROW(training::train_retriever(clips, clips, {}, config, options, monitor), Interrupted);
  const nn::ModelStage resumed = training::train_retriever(clips, clips, {}, config, options, {});
  EXPECT_EQ(resumed.config, whole.config);
  ASSERT_EQ(resumed.tensors.size(), whole.tensors.size());
  for (const auto& [name, tensor] : whole.tensors) {
    EXPECT_TRUE(tensor.equal(resumed.tensors.at(name))) << name;
  }
  // Another run must not continue from it.
  options.queues = retriever::Queues::none;
  EXPECT_THROW(training::train_retriever(clips, clips, {}, config, options, {}), Error);
  std::filesystem::remove(path);
}

TEST(RetrieverTraining, ClipsOfOneMeaningWeighAsAskedFor) {
  auto clips = separable_clips(12, 1, 1);
  training::RetrieverTrainingOptions options = quick_options(3);
  options.trainer.weight_decay = 0;
  const auto trained = [&](double weight, double rate) {
    options.same_meaning_weight = weight;
    options.trainer.learning_rate = rate;
    return training::train_retriever(clips, {}, {}, retriever::retriever_preset(ModelSize::tiny),
                                     options, {})
        .tensors;
  };
  const auto equal = [](const auto& a, const auto& b) {
    return std::all_of(a.begin(), a.end(),
                       [&](const auto& item) { return item.second.equal(b.at(item.first)); });
  };
  // Without labels the choice changes nothing.
  const auto plain = trained(1, 2e-3);
  EXPECT_TRUE(equal(plain, trained(0, 2e-3)));
  for (db::TrainingClip& clip : clips) clip.meaning = "walk/proud";
  EXPECT_TRUE(equal(plain, trained(1, 2e-3)));
  // No negative is left, in the batch or in the queues: the loss is zero and nothing moves.
  EXPECT_TRUE(equal(trained(0, 2e-3), trained(0, 0)));
  EXPECT_FALSE(equal(plain, trained(0, 0)));
}

TEST(RetrieverTraining, LearnsSeparableMotionsAndSurvivesTheFile) {
  const auto train = separable_clips(24, 8, 1), test = separable_clips(24, 2, 99);
  const nn::ModelStage stage = training::train_retriever(
      train, {}, {}, retriever::retriever_preset(ModelSize::tiny), quick_options(150), {});
  const retriever::Retriever retriever(stage);
  evaluation::RetrievalOptions measure;
  measure.protocols = {evaluation::RetrievalProtocol::duplicates};
  const auto evaluation = evaluation::evaluate_retrieval(retriever, test, measure);
  const evaluation::RetrievalSubset& figures = evaluation.protocols.at(0).subsets.at(0);
  EXPECT_GT(figures.text_to_motion.recall.recall[0], 60);  // chance: 4 %
  EXPECT_GT(figures.motion_to_text.recall.recall[0], 60);

  const std::string path = testing::TempDir() + "/retriever.safetensors";
  nn::save_model(path, {stage});
  const retriever::Retriever loaded(nn::load_stage(path, "retriever"));
  std::filesystem::remove(path);
  EXPECT_EQ(loaded.hash(), retriever.hash());
  EXPECT_EQ(loaded.feature_mode(), motion::FeatureMode::fixed);
  const std::vector<const motion::Features*> clips = {&test[0].features, &test[5].features};
  const auto one = retriever.encode_motion(clips), two = loaded.encode_motion(clips);
  EXPECT_TRUE(one.global.equal(two.global));
  EXPECT_TRUE(one.parts.equal(two.parts));
  EXPECT_EQ(one.global.sizes(), (std::vector<int64_t>{2, retriever.embedding_width()}));
  EXPECT_EQ(one.parts.sizes(), (std::vector<int64_t>{2, 6, retriever.part_width()}));
  const auto words = loaded.encode_text({"a person walks slowly", "runs"});
  EXPECT_EQ(words.states.size(2), loaded.text_width());
  EXPECT_TRUE(words.query.equal(retriever.encode_text({"a person walks slowly", "runs"}).query));
  const auto alone = loaded.encode_text({"runs"});
  EXPECT_TRUE(torch::allclose(alone.query[0], words.query[1], 1e-4, 1e-4));
}

TEST(RetrieverTraining, StartsFromAPretrainedTower) {
  const auto clips = separable_clips(12, 2, 1);
  std::vector<std::string> captions;
  for (const db::TrainingClip& clip : separable_clips(24, 1, 1))
    captions.push_back(clip.captions[0]);
  training::TextTrainingOptions text_options;
  text_options.trainer.steps = 2;
  const nn::ModelStage text = training::train_text_encoder(
      captions, encoders::text_encoder_preset(ModelSize::tiny), text_options, {});
  training::RetrieverTrainingOptions options = quick_options(1);
  options.trainer.learning_rate = 0;
  const nn::ModelStage stage = training::train_retriever(
      clips, {}, text, retriever::retriever_preset(ModelSize::tiny), options, {});
  EXPECT_EQ(stage.config["text_tower"]["vocabulary"], text.config["vocabulary"]);
  EXPECT_TRUE(stage.tensors.at("text_tower.tokens.weight").equal(text.tensors.at("tokens.weight")));
}

TEST(RetrieverTraining, ErrorsSayWhatToDo) {
  auto clips = separable_clips(2, 1, 1);
  for (db::TrainingClip& clip : clips) clip.captions = {" . "};
  EXPECT_THROW(
      training::train_retriever(clips, {}, {}, retriever::retriever_preset(ModelSize::tiny),
                                quick_options(1), {}),
      Error);
  EXPECT_THROW(retriever::Retriever(nn::ModelStage{"tokenizer", {}, {}}), Error);
  EXPECT_THROW(retriever::Retriever(nn::ModelStage{"retriever", {{"preset", "tiny"}}, {}}), Error);
  EXPECT_THROW(parse_preset("huge"), Error);
  EXPECT_THROW(retriever::parse_queues("three"), Error);
}

}  // namespace
}  // namespace remomask
