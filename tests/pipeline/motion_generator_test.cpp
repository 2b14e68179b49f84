#include "pipeline/motion_generator.h"
#include "motion/vector.h"

#include <gtest/gtest.h>
#include <torch/types.h>

#include <cmath>

#include "nn/threads.h"
#include "remomask/error.h"
#include "tests/generator/tiny_model.h"
#include "tests/pipeline/pipeline_test_tools.h"
#include "training/presets.h"

namespace remomask {
namespace {

TEST(GeneratorData, ClipsBecomeTokensFeaturesAndNeighbours) {
  const training::GeneratorData& data = tiny_model().data;
  ASSERT_EQ(data.train.clips.size(), 8u);
  EXPECT_EQ(data.captions.offsets.size(), 9u);  // eight distinct captions
  EXPECT_EQ(data.train.clips[2].tokens[0].sizes(), (std::vector<int64_t>{15, 6, 3}));
  EXPECT_EQ(data.train.clips[2].tokens[1].sizes(), (std::vector<int64_t>{14, 6, 3}));
  EXPECT_EQ(data.val.clips[0].tokens.size(), 1u);
  EXPECT_EQ(data.train.hits.neighbours.size(0), 16);
  for (size_t i = 0; i < 8; ++i) {
    const training::TokenClip& clip = data.train.clips[i];
    for (int64_t caption = 0; caption < 2; ++caption) {
      for (const training::DrawnHit& hit :
           training::best_hits(data.train.hits, clip.first_query + caption, 8)) {
        EXPECT_NE(data.train.clips[hit.motion].group, clip.group);
      }
      for (const training::DrawnHit& hit :
           training::best_hits(data.train.unfamiliar_hits, clip.first_query + caption, 8)) {
        EXPECT_NE(data.train.clips[hit.motion].group, clip.group);
        EXPECT_NE(data.train.clips[hit.motion].meaning, clip.meaning);
      }
    }
  }
  // Text features are those of the retriever, whatever they were encoded with.
  const retriever::Retriever retriever(tiny_model().stages["retriever"], tiny_words());
  const retriever::TextEncoding alone = retriever.encode_text({"a person walks"});
  const int64_t caption = data.train.clips[0].captions[0];
  EXPECT_LT((data.captions.query[caption] - alone.query[0]).abs().max().item<float>(), 1e-4f);
  EXPECT_EQ(data.captions.offsets[caption + 1] - data.captions.offsets[caption],
            alone.mask.sum().item<int64_t>());
}

TEST(Pipeline, MakesAMotionOfTheWantedLength) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  GenerateOptions options;
  options.seconds = 3;
  options.seed = 4;
  const pipeline::Generated made = generator.generate("a person walks", two_hits(), options);
  EXPECT_EQ(made.motion.frames, 60);
  EXPECT_EQ(made.motion.joints, 22);
  EXPECT_EQ(made.tokens.sizes(), (std::vector<int64_t>{15, 6, 3}));
  EXPECT_EQ(made.hits_used, 2);
  const Skeleton& skeleton = humanml_skeleton();
  for (int frame = 0; frame < made.motion.frames; ++frame) {
    for (int joint = 1; joint < 22; ++joint) {
      const double length = (joint_position(made.motion, frame, joint) -
                             joint_position(made.motion, frame, skeleton.parents[joint]))
                                .norm();
      ASSERT_NEAR(length, skeleton.bone_lengths[joint], 1e-4);
    }
  }
}

TEST(Pipeline, SameInputsSameMotionForAnyThreads) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  const auto hits = two_hits();
  GenerateOptions options;
  options.seed = 9;
  nn::set_compute_threads(1);
  const pipeline::Generated one = generator.generate("a man waves", hits, options);
  nn::set_compute_threads(4);
  const pipeline::Generated four = generator.generate("a man waves", hits, options);
  nn::set_compute_threads(0);
  EXPECT_TRUE(torch::equal(one.tokens, four.tokens));
  options.seed = 10;
  EXPECT_FALSE(torch::equal(one.tokens, generator.generate("a man waves", hits, options).tokens));
}

TEST(Pipeline, WithoutRetrievalHitsAreNotRead) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  GenerateOptions options;
  options.use_retrieval = false;
  const pipeline::Generated with = generator.generate("a man waves", two_hits(), options);
  const pipeline::Generated without = generator.generate("a man waves", {}, options);
  EXPECT_EQ(with.hits_used, 0);
  EXPECT_EQ(with.motion.frames, 100);
  EXPECT_TRUE(torch::equal(with.tokens, without.tokens));
  EXPECT_EQ(with.motion.positions, without.motion.positions);
}

TEST(Pipeline, LengthsAreExactOrEstimated) {
  std::vector<pipeline::RetrievedMotion> hits(3);
  EXPECT_EQ(pipeline::motion_frames(std::nullopt, hits, 20), 100);
  hits[0].frames = 40;
  hits[1].frames = 120;
  hits[2].frames = 81;
  EXPECT_EQ(pipeline::motion_frames(std::nullopt, hits, 20), 81);
  EXPECT_EQ(pipeline::motion_frames(2.0, hits, 20), 40);
  EXPECT_EQ(pipeline::motion_frames(3.13, hits, 20), 63);
  EXPECT_EQ(pipeline::motion_frames(100.0, hits, 20), 2000);
  for (const double wrong : {0.1, 601.0, -2.0, std::nan("")}) {
    EXPECT_THROW(pipeline::motion_frames(wrong, hits, 20), Error);
  }
  hits.resize(1);
  hits[0].frames = 300;
  EXPECT_EQ(pipeline::motion_frames(std::nullopt, hits, 20), 196);
}

TEST(Pipeline, MakesEveryLengthExactly) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  GenerateOptions options;
  for (const double seconds : {1.0, 1.05, 2.1, 3.15, 9.8, 9.85, 25.3}) {
    options.seconds = seconds;
    const pipeline::Generated made = generator.generate("a person walks", {}, options);
    EXPECT_EQ(made.motion.frames, std::lround(seconds * 20)) << seconds;
    EXPECT_EQ(made.tokens.size(0), (made.motion.frames + 3) / 4) << seconds;
  }
}

TEST(Pipeline, WrongInputsAreErrors) {
  auto stages = tiny_model().stages;
  const pipeline::Generator generator(stages, tiny_words());
  auto hits = two_hits();
  hits[1].motion.pop_back();
  EXPECT_THROW(generator.generate("a man waves", hits), Error);
  stages.erase("residual");
  EXPECT_THROW(pipeline::Generator(stages, tiny_words()), Error);
}

TEST(Presets, SizesFitTogether) {
  for (const std::string& name : preset_names()) {
    const training::ModelConfig model = training::model_preset(parse_preset(name));
    EXPECT_EQ(model.masked.codes, model.tokenizer.codes) << name;
    EXPECT_EQ(model.residual.rows, model.tokenizer.rows) << name;
    EXPECT_EQ(model.residual.levels, model.tokenizer.levels) << name;
    EXPECT_EQ(model.masked.preset, name);
    EXPECT_NO_THROW(generator::MaskedTransformer(model.masked));
    EXPECT_NO_THROW(generator::ResidualTransformer(model.residual));
  }
  EXPECT_EQ(training::model_preset(parse_preset("momask")).masked.rows, 1);
  EXPECT_EQ(training::model_preset(parse_preset("momask")).masked.max_hits, 0);
  EXPECT_EQ(training::model_preset(parse_preset("paper")).masked.width, 512);
  EXPECT_EQ(training::model_preset(parse_preset("paper")).residual.width, 384);
  EXPECT_THROW(training::model_preset(parse_preset("huge")), Error);
}

}  // namespace
}  // namespace remomask
