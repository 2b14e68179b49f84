#include "evaluation/evaluator.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include <filesystem>

#include "evaluation/evaluator_network.h"
#include "evaluation/evaluator_words.h"
#include "evaluation/t2m_evaluator.h"
#include "evaluation/word_classes.h"
#include "nn/safetensors.h"
#include "remomask/error.h"
#include "tests/evaluation/evaluator_test_tools.h"
#include "tests/retriever/retriever_test_tools.h"

namespace remomask {
namespace {

TEST(WordClasses, ListsInflectionsAndTheRest) {
  EXPECT_EQ(evaluation::word_class("left"), evaluation::WordClass::place);
  EXPECT_EQ(evaluation::word_class("backwards"), evaluation::WordClass::place);
  EXPECT_EQ(evaluation::word_class("hands"), evaluation::WordClass::body);
  EXPECT_EQ(evaluation::word_class("feet"), evaluation::WordClass::body);
  EXPECT_EQ(evaluation::word_class("chairs"), evaluation::WordClass::object);
  for (const char* word : {"walk", "walks", "walking", "walked", "running", "ran", "swinging",
                           "balancing", "raises", "raised", "sat", "stopping", "squats"}) {
    EXPECT_EQ(evaluation::word_class(word), evaluation::WordClass::act) << word;
  }
  EXPECT_EQ(evaluation::word_class("slowly"), evaluation::WordClass::description);
  EXPECT_EQ(evaluation::word_class("the"), evaluation::WordClass::determiner);
  EXPECT_EQ(evaluation::word_class("with"), evaluation::WordClass::adposition);
  EXPECT_EQ(evaluation::word_class("two"), evaluation::WordClass::numeral);
  for (const char* word : {"person", "proudly", "its elf", "ing", "bus"}) {
    EXPECT_EQ(evaluation::word_class(word), evaluation::WordClass::other) << word;
  }
  EXPECT_EQ(static_cast<int64_t>(evaluation::WordClass::other), evaluation::kWordClasses - 1);
}

TEST(EvaluatorWords, StartWordsEndAndPadding) {
  const evaluation::EvaluatorWords words({"sos", "eos", "unk", "a", "person", "wave"}, 4);
  const evaluation::WordBatch batch = words.encode({"A person waves wildly!", "", "a a a a a a"});
  EXPECT_TRUE(batch.ids.equal(torch::tensor(
      {{0L, 3L, 4L, 5L, 2L, 1L}, {0L, 1L, 2L, 2L, 2L, 2L}, {0L, 3L, 3L, 3L, 3L, 1L}})));
  EXPECT_TRUE(batch.lengths.equal(torch::tensor({6L, 2L, 6L})));
  EXPECT_EQ(batch.classes[0][1].item<int64_t>(),
            static_cast<int64_t>(evaluation::WordClass::determiner));
  EXPECT_EQ(batch.classes[1][3].item<int64_t>(),
            static_cast<int64_t>(evaluation::WordClass::other));
  EXPECT_THROW(evaluation::EvaluatorWords({"a", "b", "c"}, 4), Error);
  EXPECT_THROW(evaluation::EvaluatorWords({"sos", "eos", "unk", "a", "a"}, 4), Error);
}

TEST(EvaluatorWords, VocabularyOfRepeatedWords) {
  EXPECT_EQ(evaluation::evaluator_vocabulary(
                {"A man walks.", "a man runs", "a left-handed throw", "unk unk"}),
            (std::vector<std::string>{"sos", "eos", "unk", "a", "man"}));
}

TEST(Evaluator, AloneAndInABatchTheSame) {
  const evaluation::Evaluator evaluator(untrained_evaluator_stage(3));
  std::vector<motion::Features> motions;
  for (const int frames : {4, 23, 60, 192, 195, 196, 230}) {
    motions.push_back(random_features(frames, static_cast<uint64_t>(frames)));
  }
  std::vector<const motion::Features*> pointers;
  for (const motion::Features& motion : motions) pointers.push_back(&motion);
  const at::Tensor together = evaluator.embed_motion(pointers);
  EXPECT_EQ(together.sizes(), (std::vector<int64_t>{7, 16}));
  for (size_t i = 0; i < motions.size(); ++i) {
    const at::Tensor alone =
        evaluator.embed_motion(std::vector<const motion::Features*>{pointers[i]})[0];
    EXPECT_TRUE(torch::allclose(alone, together[static_cast<int64_t>(i)], 1e-4, 1e-5)) << i;
  }
  const std::vector<std::string> captions = {"a person walks slowly", "runs",
                                             "a person waves wildly and then walks proudly"};
  const at::Tensor texts = evaluator.embed_text(captions);
  for (size_t i = 0; i < captions.size(); ++i) {
    EXPECT_TRUE(torch::allclose(evaluator.embed_text({captions[i]})[0],
                                texts[static_cast<int64_t>(i)], 1e-4, 1e-5));
  }
  EXPECT_EQ(evaluator.embed_text({}).sizes(), (std::vector<int64_t>{0, 16}));
}

TEST(Evaluator, ReadsEverythingButContactsUpToAMultipleOfFour) {
  const evaluation::Evaluator evaluator(untrained_evaluator_stage(3));
  const motion::Features motion = random_features(23, 1);
  const auto embed = [&](const motion::Features& features) {
    return evaluator.embed_motion(std::vector<const motion::Features*>{&features});
  };
  const at::Tensor before = embed(motion);
  motion::Features changed = motion;
  changed.row(5)[260] += 1;  // a contact
  for (int t = 20; t < 23; ++t) changed.row(t)[7] += 1;
  EXPECT_TRUE(embed(changed).equal(before));
  changed.row(19)[258] += 1;
  EXPECT_FALSE(embed(changed).equal(before));
}

TEST(Evaluator, RefusesWhatDoesNotFit) {
  const evaluation::Evaluator evaluator(untrained_evaluator_stage(3));
  const motion::Features short_motion = random_features(3, 1), narrow(20, 251);
  EXPECT_THROW(evaluator.embed_motion(std::vector<const motion::Features*>{&short_motion}), Error);
  EXPECT_THROW(evaluator.embed_motion(std::vector<const motion::Features*>{&narrow}), Error);
  nn::ModelStage stage = untrained_evaluator_stage(3);
  stage.tensors.erase("motion_encoder.hidden");
  EXPECT_THROW(evaluation::Evaluator{stage}, Error);
  stage = untrained_evaluator_stage(3);
  stage.kind = "retriever";
  EXPECT_THROW(evaluation::Evaluator{stage}, Error);
}

TEST(Evaluator, StatisticsAverageGroupsAndWeightTheRoot) {
  evaluation::EvaluatorConfig config = tiny_evaluator_config();
  config.root_weight = 5;
  evaluation::EvaluatorNetwork network(config);
  // Column c alternates around c with amplitude 1 (columns 1 and 2: 1 and 3).
  motion::Features motion(8, 263);
  for (int t = 0; t < 8; ++t) {
    for (int c = 0; c < 263; ++c) {
      const float amplitude = c == 2 ? 3.f : 1.f;
      motion.row(t)[c] = static_cast<float>(c) + (t % 2 == 0 ? amplitude : -amplitude);
    }
  }
  network->set_statistics({&motion});
  const at::Tensor normalised = network->batch({{&motion, 0, 8}}).features[0][0];
  EXPECT_NEAR(normalised[0].item<double>(), 5, 1e-4);
  EXPECT_NEAR(normalised[1].item<double>(), 2.5, 1e-4);  // the group's deviation is 2
  EXPECT_NEAR(normalised[2].item<double>(), 7.5, 1e-4);
  EXPECT_NEAR(normalised[3].item<double>(), 5, 1e-4);
  EXPECT_NEAR(normalised[4].item<double>(), 1, 1e-4);
  EXPECT_NEAR(normalised[258].item<double>(), 1, 1e-4);
  EXPECT_NEAR(normalised[262].item<double>(), 5, 1e-4);
}

/// Names and shapes of text_mot_match/model/finest.tar, for T2M's sizes.
nn::TensorMap synthetic_checkpoint(int64_t words, int64_t columns) {
  std::map<std::string, std::vector<int64_t>> shapes = {
      {"movement_encoder.main.0.weight", {512, columns - 4, 4}},
      {"movement_encoder.main.0.bias", {512}},
      {"movement_encoder.main.3.weight", {512, 512, 4}},
      {"movement_encoder.main.3.bias", {512}},
      {"movement_encoder.out_net.weight", {512, 512}},
      {"movement_encoder.out_net.bias", {512}},
      {"text_encoder.pos_emb.weight", {300, 15}},
      {"text_encoder.pos_emb.bias", {300}},
      {"mean", {columns}},
      {"std", {columns}},
      {"word_vectors", {words, 300}}};
  const auto add_gru = [&](const std::string& prefix, int64_t input, int64_t hidden) {
    shapes[prefix + "hidden"] = {2, 1, hidden};
    shapes[prefix + "input_emb.weight"] = {hidden, input};
    shapes[prefix + "input_emb.bias"] = {hidden};
    for (const char* side : {"", "_reverse"}) {
      for (const char* kind : {"ih", "hh"}) {
        shapes[prefix + "gru.weight_" + kind + "_l0" + side] = {3 * hidden, hidden};
        shapes[prefix + "gru.bias_" + kind + "_l0" + side] = {3 * hidden};
      }
    }
    shapes[prefix + "output_net.0.weight"] = {hidden, 2 * hidden};
    shapes[prefix + "output_net.3.weight"] = {512, hidden};
    for (const char* name : {"output_net.0.bias", "output_net.1.weight", "output_net.1.bias"}) {
      shapes[prefix + name] = {hidden};
    }
    shapes[prefix + "output_net.3.bias"] = {512};
  };
  add_gru("motion_encoder.", 512, 1024);
  add_gru("text_encoder.", 300, 512);
  nn::TensorMap tensors;
  torch::manual_seed(5);
  for (const auto& [name, shape] : shapes) tensors[name] = torch::randn(shape) * 0.05;
  tensors["std"] = torch::ones({columns}, torch::kDouble);
  return tensors;
}

TEST(T2mEvaluator, LoadsACheckpointByNamesAndShapes) {
  const std::string path = testing::TempDir() + "/finest.safetensors";
  nn::TensorMap tensors = synthetic_checkpoint(5, 263);
  tensors["std"] = tensors["std"].to(torch::kFloat);
  const std::map<std::string, std::string> metadata = {
      {"vocabulary", R"(["sos", "eos", "unk", "walk", "person"])"}};
  nn::save_safetensors(path, tensors, metadata);
  const evaluation::Evaluator evaluator = evaluation::load_evaluator(path);
  EXPECT_EQ(evaluator.feature_mode(), motion::FeatureMode::official);
  EXPECT_EQ(evaluator.config().skeleton, "humanml3d");

  const at::Tensor text = evaluator.embed_text({"person walks"});
  EXPECT_EQ(text.sizes(), (std::vector<int64_t>{1, 512}));
  tensors["text_encoder.output_net.3.bias"] += 1;
  nn::save_safetensors(path, tensors, metadata);
  EXPECT_TRUE(torch::allclose(evaluation::load_evaluator(path).embed_text({"person walks"}),
                              text + 1, 1e-4, 1e-4));

  nn::TensorMap wrong = tensors;
  wrong["motion_encoder.hidden"] = torch::zeros({2, 1, 512});
  nn::save_safetensors(path, wrong, metadata);
  EXPECT_THROW(evaluation::load_evaluator(path), Error);
  wrong = tensors;
  wrong.erase("word_vectors");
  nn::save_safetensors(path, wrong, metadata);
  EXPECT_THROW(evaluation::load_evaluator(path), FileError);
  nn::save_safetensors(path, tensors, {});
  EXPECT_THROW(evaluation::load_evaluator(path), FileError);
  std::filesystem::remove(path);
}

TEST(T2mEvaluator, KitIsToldByItsColumns) {
  nn::TensorFile file;
  file.tensors = synthetic_checkpoint(3, 251);
  file.metadata["vocabulary"] = R"(["sos", "eos", "unk"])";
  ASSERT_TRUE(evaluation::is_t2m_evaluator(file));
  const evaluation::Evaluator evaluator(evaluation::import_t2m_evaluator(file, "kit"));
  EXPECT_EQ(evaluator.config().skeleton, "kit");
}

TEST(MovementEncoder, FirstTokenByHand) {
  evaluation::MovementEncoder encoder(2, 3);
  encoder->eval();
  const auto tensors = nn::module_tensors(*encoder);
  torch::manual_seed(1);
  const at::Tensor motion = torch::randn({1, 8, 2});
  const auto convolve = [](const at::Tensor& input, const at::Tensor& weight,
                           const at::Tensor& bias, int64_t t) {
    at::Tensor sum = bias.clone();
    for (int64_t k = 0; k < 4; ++k) {
      const int64_t at = 2 * t - 1 + k;
      if (at < 0 || at >= input.size(0)) continue;
      sum += weight.select(2, k).mv(input[at]);
    }
    return torch::where(sum > 0, sum, 0.2 * sum);
  };
  std::vector<at::Tensor> half;
  for (int64_t t = 0; t < 4; ++t) {
    half.push_back(convolve(motion[0], tensors.at("main.0.weight"), tensors.at("main.0.bias"), t));
  }
  const at::Tensor first =
      convolve(torch::stack(half), tensors.at("main.3.weight"), tensors.at("main.3.bias"), 0);
  const at::Tensor expected = tensors.at("out_net.weight").mv(first) + tensors.at("out_net.bias");
  at::NoGradGuard no_grad;
  EXPECT_TRUE(torch::allclose(encoder(motion)[0][0], expected, 1e-5, 1e-6));
}

}  // namespace
}  // namespace remomask
