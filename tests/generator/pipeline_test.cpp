#include "generator/pipeline.h"

#include <gtest/gtest.h>
#include <torch/types.h>

#include <cmath>

#include "base/error.h"
#include "generator/generator_data.h"
#include "generator/presets.h"
#include "generator/tokenizer_training.h"
#include "generator/transformer_training.h"
#include "nn/threads.h"
#include "retriever/training.h"
#include "tokenizer_test_tools.h"

namespace remomask {
namespace {

std::vector<TrainingClip> captioned_clips() {
  std::vector<TrainingClip> clips = swinging_clips({40, 48, 60, 44, 52, 72, 41, 64});
  const std::vector<std::string> texts = {"a person walks", "someone runs in a circle",
                                          "a man waves", "a person jumps and turns"};
  for (size_t i = 0; i < clips.size(); ++i) {
    clips[i].split = "train";
    clips[i].group = static_cast<int>(i / 2);
    clips[i].captions = {texts[i % 4], texts[(i + 1) % 4] + " slowly"};
  }
  return clips;
}

/// All four networks of preset tiny after two steps each, made once.
struct TinyModel {
  std::map<std::string, ModelStage> stages;
  GeneratorData data;

  TinyModel() {
    const auto clips = captioned_clips();
    const ModelConfig config = model_preset("tiny");
    const auto trainer = [](const std::string& name) {
      TrainerOptions options;
      options.steps = 2;
      options.stage_name = name;
      return options;
    };
    RetrieverTrainingOptions retriever_options("tiny");
    retriever_options.trainer = trainer("retriever");
    retriever_options.batch = 4;
    stages["retriever"] =
        train_retriever(clips, {}, std::nullopt, config.retriever, retriever_options, {});
    TokenizerTrainingOptions tokenizer_options;
    tokenizer_options.trainer = trainer("tokenizer");
    tokenizer_options.window = 32;
    tokenizer_options.batch_frames = 256;
    stages["tokenizer"] = train_tokenizer(clips, clips, config.tokenizer, tokenizer_options, {});
    data = prepare_generator_data(clips, {clips[0]}, Tokenizer(stages["tokenizer"]),
                                  Retriever(stages["retriever"]), {});
    TransformerTrainingOptions options;
    options.batch = 4;
    options.trainer = trainer("masked");
    stages["masked"] = train_masked(config.masked, data, options, {});
    options.trainer = trainer("residual");
    stages["residual"] = train_residual(config.residual, data, options, {});
  }
};

TinyModel& tiny_model() {
  static TinyModel model;
  return model;
}

std::vector<RetrievedMotion> two_hits(const Generator& generator) {
  const GeneratorData& data = tiny_model().data;
  std::vector<RetrievedMotion> hits;
  for (int64_t i = 0; i < 2; ++i) {
    RetrievedMotion hit;
    hit.clip_id = i + 1;
    hit.frames = i == 0 ? 40 : 60;
    hit.similarity = 0.7;
    const auto motion = data.motion[i].contiguous(), text = data.motion_text[i].contiguous();
    hit.motion.assign(motion.data_ptr<float>(),
                      motion.data_ptr<float>() + generator.retriever().embedding_width());
    hit.text.assign(text.data_ptr<float>(),
                    text.data_ptr<float>() + generator.retriever().embedding_width());
    hits.push_back(hit);
  }
  return hits;
}

TEST(GeneratorData, ClipsBecomeTokensFeaturesAndNeighbours) {
  const GeneratorData& data = tiny_model().data;
  ASSERT_EQ(data.train.clips.size(), 8u);
  EXPECT_EQ(data.captions.offsets.size(), 9u);  // eight distinct captions
  EXPECT_EQ(data.train.clips[2].tokens[0].sizes(), (std::vector<int64_t>{15, 6, 3}));
  EXPECT_EQ(data.train.clips[2].tokens[1].sizes(), (std::vector<int64_t>{14, 6, 3}));
  EXPECT_EQ(data.val.clips[0].tokens.size(), 1u);
  EXPECT_EQ(data.train.hits.neighbours.size(0), 16);
  for (size_t i = 0; i < 8; ++i) {
    const TokenClip& clip = data.train.clips[i];
    for (int64_t caption = 0; caption < 2; ++caption) {
      for (const DrawnHit& hit : best_hits(data.train.hits, clip.first_query + caption, 8)) {
        EXPECT_NE(data.train.clips[hit.motion].group, clip.group);
      }
    }
  }
  // Text features are those of the retriever, whatever they were encoded with.
  const Retriever retriever(tiny_model().stages["retriever"]);
  const TextEncoding alone = retriever.encode_text({"a person walks"});
  const int64_t caption = data.train.clips[0].captions[0];
  EXPECT_LT((data.captions.query[caption] - alone.query[0]).abs().max().item<float>(), 1e-4f);
  EXPECT_EQ(data.captions.offsets[caption + 1] - data.captions.offsets[caption],
            alone.mask.sum().item<int64_t>());
}

TEST(Pipeline, MakesAMotionOfTheWantedLength) {
  const Generator generator(tiny_model().stages);
  GenerateOptions options;
  options.seconds = 3;
  options.seed = 4;
  const Generated made = generator.generate("a person walks", two_hits(generator), options);
  EXPECT_EQ(made.motion.frames, 60);
  EXPECT_EQ(made.motion.joints, 22);
  EXPECT_EQ(made.tokens.sizes(), (std::vector<int64_t>{15, 6, 3}));
  EXPECT_EQ(made.hits_used, 2);
  const Skeleton& skeleton = humanml_skeleton();
  for (int frame = 0; frame < made.motion.frames; ++frame) {
    for (int joint = 1; joint < 22; ++joint) {
      const double length = (made.motion.position(frame, joint) -
                             made.motion.position(frame, skeleton.parents[joint]))
                                .norm();
      ASSERT_NEAR(length, skeleton.bone_lengths[joint], 1e-4);
    }
  }
}

TEST(Pipeline, SameInputsSameMotionForAnyThreads) {
  const Generator generator(tiny_model().stages);
  const auto hits = two_hits(generator);
  GenerateOptions options;
  options.seed = 9;
  set_compute_threads(1);
  const Generated one = generator.generate("a man waves", hits, options);
  set_compute_threads(4);
  const Generated four = generator.generate("a man waves", hits, options);
  set_compute_threads(0);
  EXPECT_TRUE(torch::equal(one.tokens, four.tokens));
  options.seed = 10;
  EXPECT_FALSE(torch::equal(one.tokens, generator.generate("a man waves", hits, options).tokens));
}

TEST(Pipeline, WithoutRetrievalHitsAreNotRead) {
  const Generator generator(tiny_model().stages);
  GenerateOptions options;
  options.use_retrieval = false;
  const Generated with = generator.generate("a man waves", two_hits(generator), options);
  const Generated without = generator.generate("a man waves", {}, options);
  EXPECT_EQ(with.hits_used, 0);
  EXPECT_EQ(with.motion.frames, 100);
  EXPECT_TRUE(torch::equal(with.tokens, without.tokens));
  EXPECT_EQ(with.motion.positions, without.motion.positions);
}

TEST(Pipeline, LengthsAreChosenAndClamped) {
  std::vector<RetrievedMotion> hits(3);
  EXPECT_EQ(token_frames(std::nullopt, hits, 20), 25);
  hits[0].frames = 40;
  hits[1].frames = 120;
  hits[2].frames = 80;
  EXPECT_EQ(token_frames(std::nullopt, hits, 20), 20);
  EXPECT_EQ(token_frames(2.0, hits, 20), 10);
  EXPECT_EQ(token_frames(0.1, hits, 20), 5);
  EXPECT_EQ(token_frames(100.0, hits, 20), 49);
  EXPECT_THROW(token_frames(std::nan(""), hits, 20), Error);
}

TEST(Pipeline, WrongInputsAreErrors) {
  auto stages = tiny_model().stages;
  const Generator generator(stages);
  auto hits = two_hits(generator);
  hits[1].motion.pop_back();
  EXPECT_THROW(generator.generate("a man waves", hits), Error);
  stages.erase("residual");
  EXPECT_THROW(Generator{stages}, Error);
}

TEST(Presets, SizesFitTogether) {
  for (const std::string name : {"tiny", "base", "paper", "momask"}) {
    const ModelConfig model = model_preset(name);
    EXPECT_EQ(model.masked.codes, model.tokenizer.codes) << name;
    EXPECT_EQ(model.residual.rows, model.tokenizer.rows) << name;
    EXPECT_EQ(model.residual.levels, model.tokenizer.levels) << name;
    EXPECT_EQ(model.masked.preset, name);
    EXPECT_NO_THROW(MaskedTransformer(model.masked));
    EXPECT_NO_THROW(ResidualTransformer(model.residual));
  }
  EXPECT_EQ(model_preset("momask").masked.rows, 1);
  EXPECT_EQ(model_preset("momask").masked.max_hits, 0);
  EXPECT_EQ(model_preset("paper").masked.width, 512);
  EXPECT_EQ(model_preset("paper").residual.width, 384);
  EXPECT_THROW(model_preset("huge"), Error);
}

}  // namespace
}  // namespace remomask
