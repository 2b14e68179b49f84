#include "training/retriever_training.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include <filesystem>
#include <set>

#include "evaluation/retrieval_metrics.h"
#include "remomask/error.h"
#include "retriever/retriever_model.h"
#include "tests/encoders/tiny_words.h"
#include "tests/retriever/retriever_test_tools.h"
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
  const nn::ModelStage whole =
      training::train_retriever(clips, clips, tiny_words(), config, options, {});

  options.trainer.checkpoint_path = path;
  options.trainer.checkpoint_seconds = 0;
  std::stop_source stop;
  Monitor monitor;
  monitor.stop = stop.get_token();
  monitor.progress = [&](const Progress& progress) {
    if (progress.done >= 1) stop.request_stop();
  };
  EXPECT_THROW(training::train_retriever(clips, clips, tiny_words(), config, options, monitor),
               Interrupted);
  const nn::ModelStage resumed =
      training::train_retriever(clips, clips, tiny_words(), config, options, {});
  EXPECT_EQ(resumed.config, whole.config);
  ASSERT_EQ(resumed.tensors.size(), whole.tensors.size());
  for (const auto& [name, tensor] : whole.tensors) {
    EXPECT_TRUE(tensor.equal(resumed.tensors.at(name))) << name;
  }
  // Another run must not continue from it.
  options.queues = retriever::Queues::none;
  EXPECT_THROW(training::train_retriever(clips, clips, tiny_words(), config, options, {}), Error);
  std::filesystem::remove(path);
}

TEST(RetrieverTraining, ClipsOfOneMeaningWeighAsAskedFor) {
  auto clips = separable_clips(12, 1, 1);
  training::RetrieverTrainingOptions options = quick_options(3);
  options.trainer.weight_decay = 0;
  const auto trained = [&](double weight, double rate) {
    options.same_meaning_weight = weight;
    options.trainer.learning_rate = rate;
    return training::train_retriever(clips, {}, tiny_words(),
                                     retriever::retriever_preset(ModelSize::tiny), options, {})
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
      train, {}, tiny_words(), retriever::retriever_preset(ModelSize::tiny), quick_options(150),
      {});
  const retriever::Retriever retriever(stage, tiny_words());
  evaluation::RetrievalOptions measure;
  measure.protocols = {evaluation::RetrievalProtocol::duplicates};
  const auto evaluation = evaluation::evaluate_retrieval(retriever, test, measure);
  const evaluation::RetrievalSubset& figures = evaluation.protocols.at(0).subsets.at(0);
  EXPECT_GT(figures.text_to_motion.recall.recall[0], 60);  // chance: 4 %
  EXPECT_GT(figures.motion_to_text.recall.recall[0], 60);

  const std::string path = testing::TempDir() + "/retriever.safetensors";
  nn::save_model(path, {stage});
  const retriever::Retriever loaded(nn::load_stage(path, "retriever"), tiny_words());
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

TEST(RetrieverTraining, LeavesTheSentenceEncoderAlone) {
  const std::string before = tiny_words()->tower_hash();
  const at::Tensor words = tiny_text_stage().tensors.at("words").clone();
  const nn::ModelStage stage =
      training::train_retriever(separable_clips(12, 2, 1), {}, tiny_words(),
                                retriever::retriever_preset(ModelSize::tiny), quick_options(2), {});
  EXPECT_TRUE(words.equal(tiny_text_stage().tensors.at("words")));
  EXPECT_EQ(stage.config.at("text_encoder"), before);
  EXPECT_EQ(stage.config.at("text_encoder_width"), tiny_words()->width());
  for (const auto& [name, tensor] : stage.tensors) {
    EXPECT_FALSE(name.starts_with("words") || name.starts_with("block")) << name;
  }
  // It reads what the encoder says of the words, whatever stands around them in a batch.
  const retriever::Retriever retriever(stage, tiny_words());
  const retriever::TextEncoding both = retriever.encode_text({"runs", "a person walks slowly"});
  const encoders::TokenBatch tokens = tiny_words()->tower()->tokenize({"runs"});
  const at::NoGradGuard no_grad;
  const at::Tensor states = tiny_words()->tower()->encode(tokens.ids, tokens.mask).states[0];
  EXPECT_TRUE(torch::allclose(both.states[0].slice(0, 0, states.size(0)), states, 1e-4, 1e-5));
}

TEST(RetrieverTraining, TunesACopyOfTheLastLayers) {
  const at::Tensor frozen = tiny_text_stage().tensors.at("block1.query.weight").clone();
  retriever::RetrieverConfig config = retriever::retriever_preset(ModelSize::tiny);
  config.tuned_text_layers = 1;
  const nn::ModelStage stage = training::train_retriever(
      separable_clips(12, 2, 1), {}, tiny_words(), config, quick_options(3), {});
  EXPECT_TRUE(frozen.equal(tiny_text_stage().tensors.at("block1.query.weight")));
  const at::Tensor tuned = stage.tensors.at("text_tail.block1.query.weight");
  EXPECT_FALSE(tuned.equal(frozen));
  EXPECT_LT((tuned - frozen).abs().max().item<float>(), 0.1);
  EXPECT_FALSE(stage.tensors.contains("text_tail.block0.query.weight"));
  const retriever::Retriever retriever(stage, tiny_words());
  const encoders::TokenBatch tokens = tiny_words()->tower()->tokenize({"runs"});
  const at::NoGradGuard no_grad;
  const at::Tensor plain = tiny_words()->tower()->encode(tokens.ids, tokens.mask).states;
  EXPECT_FALSE(torch::allclose(retriever.encode_text({"runs"}).states, plain, 1e-3, 1e-4));
}

TEST(RetrieverTraining, GoesOnFromTheWeightsOfAModel) {
  const auto clips = separable_clips(12, 2, 1);
  const retriever::RetrieverConfig config = retriever::retriever_preset(ModelSize::tiny);
  training::RetrieverTrainingOptions options = quick_options(3);
  const nn::ModelStage first =
      training::train_retriever(clips, {}, tiny_words(), config, options, {});
  options.trainer.learning_rate = 0;
  options.start = first;
  options.start->tensors["text_parts.weight"] = torch::zeros({3, 3});
  const nn::ModelStage second =
      training::train_retriever(clips, {}, tiny_words(), config, options, {});
  EXPECT_EQ(second.config.at("start").at("anew"), nlohmann::json({"text_parts.weight"}));
  for (const auto& [name, tensor] : first.tensors) {
    EXPECT_EQ(tensor.equal(second.tensors.at(name)), name != "text_parts.weight") << name;
  }
  options.start->tensors = {{"nothing", torch::zeros({1})}};
  EXPECT_THROW(training::train_retriever(clips, {}, tiny_words(), config, options, {}), Error);
}

TEST(RetrieverTraining, AnotherSentenceEncoderIsRefused) {
  nn::ModelStage other = tiny_text_stage();
  other.tensors["words"] = other.tensors["words"] + 1;
  const auto words = std::make_shared<const encoders::SentenceEncoder>(
      encoders::SentenceEncoder::of_stages({{encoders::kTextEncoderStage, other}}, "other"));
  const retriever::RetrieverConfig config = tiny_retriever_config();
  const retriever::RetrieverModel model(config, tiny_words()->tower());
  const nn::ModelStage stage{"retriever", config, nn::module_tensors(model)};
  EXPECT_NO_THROW(retriever::Retriever(stage, tiny_words()));
  EXPECT_THROW(retriever::Retriever(stage, words), Error);
  nn::ModelStage old = stage;
  old.config["text_tower"] = {{"tower", "wordpiece_transformer"}};
  EXPECT_THROW(retriever::Retriever(old, tiny_words()), Error);
}

TEST(RetrieverTraining, ErrorsSayWhatToDo) {
  auto clips = separable_clips(2, 1, 1);
  for (db::TrainingClip& clip : clips) clip.captions = {" . "};
  EXPECT_THROW(
      training::train_retriever(clips, {}, tiny_words(),
                                retriever::retriever_preset(ModelSize::tiny), quick_options(1), {}),
      Error);
  EXPECT_THROW(retriever::Retriever(nn::ModelStage{"tokenizer", {}, {}}, tiny_words()), Error);
  EXPECT_THROW(
      retriever::Retriever(nn::ModelStage{"retriever", {{"preset", "tiny"}}, {}}, tiny_words()),
      Error);
  EXPECT_THROW(parse_preset("huge"), Error);
  EXPECT_THROW(retriever::parse_queues("three"), Error);
}

}  // namespace
}  // namespace remomask
