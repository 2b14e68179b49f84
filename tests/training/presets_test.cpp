#include "training/presets.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

#include "pipeline/motion_generator.h"
#include "remomask/error.h"
#include "tests/generator/tiny_model.h"
#include "tokenizer/tokenizer_network.h"

namespace remomask {
namespace {

int64_t parameter_count(const torch::nn::Module& module) {
  int64_t count = 0;
  for (const auto& parameter : module.parameters()) count += parameter.numel();
  return count;
}

TEST(PresetsTest, SizesAgreeBetweenTheNetworks) {
  for (const std::string& name : preset_names()) {
    const training::ModelConfig model = training::model_preset(parse_preset(name));
    EXPECT_EQ(model.masked.rows, model.tokenizer.rows) << name;
    EXPECT_EQ(model.residual.codes, model.tokenizer.codes) << name;
    EXPECT_EQ(model.masked.embedding_width, model.retriever.embedding) << name;
    EXPECT_NO_THROW(tokenizer::check_tokenizer_config(model.tokenizer)) << name;
  }
  EXPECT_THROW(training::model_preset(parse_preset("huge")), Error);
}

// The published depth, width and shape: what the preset is for.
TEST(PresetsTest, MomaskIsOneRowWithoutRetrieval) {
  const training::ModelConfig model = training::model_preset(parse_preset("momask"));
  EXPECT_EQ(model.tokenizer.rows, 1);
  EXPECT_EQ(model.masked.max_hits, 0);
  tokenizer::TokenizerNetwork network(model.tokenizer);
  // 19,436,807 parameters of MoMask's convolutions (its codebooks are buffers here too).
  EXPECT_NEAR(static_cast<double>(parameter_count(*network)), 19436807.0, 0.02 * 19436807.0);
}

// A comparison of the two designs is fair when neither has more weights.
TEST(PresetsTest, MomaskOfASizeHasAboutItsWeights) {
  for (const char* size : {"small", "base"}) {
    const training::ModelConfig body = training::model_preset(parse_preset(size));
    const training::ModelConfig row =
        training::model_preset(parse_preset(std::string("momask-") + size));
    EXPECT_EQ(row.tokenizer.rows, 1);
    EXPECT_EQ(row.masked.attention, "joined");
    EXPECT_EQ(row.masked.preset, std::string("momask-") + size);
    const auto ratio = [](const torch::nn::Module& a, const torch::nn::Module& b) {
      return static_cast<double>(parameter_count(a)) / static_cast<double>(parameter_count(b));
    };
    EXPECT_NEAR(ratio(*tokenizer::TokenizerNetwork(row.tokenizer),
                      *tokenizer::TokenizerNetwork(body.tokenizer)),
                1, 0.2)
        << size;
  }
  EXPECT_EQ(parse_preset("momask-base"), (Preset{ModelSize::base, true}));
  EXPECT_EQ(parse_preset("momask"), (Preset{ModelSize::momask, false}));
  for (const std::string& name : preset_names()) {
    EXPECT_EQ(preset_name(parse_preset(name)), name);
  }
  EXPECT_THROW(parse_preset("momask-paper"), Error);
}

TEST(PresetsTest, PaperTransformersHaveThePublishedShape) {
  const training::ModelConfig model = training::model_preset(parse_preset("paper"));
  EXPECT_EQ(model.masked.layers, 6);
  EXPECT_EQ(model.masked.width, 512);
  EXPECT_EQ(model.residual.width, 384);
  EXPECT_EQ(model.tokenizer.codes, 256);
  EXPECT_EQ(model.tokenizer.code_width, 1024);
}

// The road of the baseline, from motions to a generated motion, with its sizes cut.
TEST(PresetsTest, OneRowWithoutRetrievalWorksFromEndToEnd) {
  training::ModelConfig model = training::model_preset(parse_preset("momask"));
  model.retriever = retriever::retriever_preset(ModelSize::tiny);
  model.tokenizer.widths = {16, 16, 16};
  model.tokenizer.codes = model.masked.codes = model.residual.codes = 16;
  model.tokenizer.code_width = 8;
  model.masked.width = model.residual.width = 32;
  model.masked.heads = model.residual.heads = 2;
  model.masked.layers = model.residual.layers = 1;
  const pipeline::Generator generator(TinyModel(model, captioned_clips()).stages, tiny_words());
  GenerateOptions generate;
  generate.seconds = 2.0;
  const pipeline::Generated made = generator.generate("a person walks", {}, generate);
  EXPECT_EQ(made.tokens.sizes(), (std::vector<int64_t>{10, 1, 6}));
  EXPECT_EQ(made.motion.frames, 40);
}

}  // namespace
}  // namespace remomask
