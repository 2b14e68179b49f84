#include "encoders/low_rank_adapter.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

#include <filesystem>

#include "remomask/error.h"
#include "tests/base/test_folder.h"
#include "tests/encoders/tiny_encoder.h"

namespace remomask {
namespace {

class LowRankAdapterTest : public ::testing::Test {
 protected:
  void SetUp() override {
    torch::manual_seed(3);
    text_ = tiny_encoder_stage({"walk", "run", "jump", "kick"});
    config_ = encoders::read_bert_config(text_.config);
    encoder_ = std::make_shared<encoders::BertEncoder>(config_, text_.tensors, "test");
    encoder_->eval();
    adapter_ = std::make_shared<encoders::LowRankAdapter>(encoders::AdapterConfig{4, 8},
                                                          encoders::bert_linear_layers(config_));
  }

  /// As if it had learnt something.
  void fill() {
    at::NoGradGuard no_grad;
    for (at::Tensor& parameter : adapter_->parameters()) {
      parameter.copy_(torch::randn_like(parameter) * 0.2);
    }
  }
  static at::Tensor pooled(encoders::BertEncoder& encoder) {
    const encoders::TokenBatch tokens = encoder.tokenize({"walk run", "jump kick walk"});
    return encoder.encode(tokens.ids, tokens.mask).pooled;
  }

  nn::ModelStage text_;
  encoders::BertConfig config_;
  std::shared_ptr<encoders::BertEncoder> encoder_;
  std::shared_ptr<encoders::LowRankAdapter> adapter_;
};

TEST_F(LowRankAdapterTest, ChangesNothingAtTheStart) {
  const at::Tensor before = pooled(*encoder_);
  encoder_->set_adapter(adapter_);
  EXPECT_TRUE(torch::equal(pooled(*encoder_), before));
  encoder_->set_adapter(nullptr);
  EXPECT_TRUE(torch::equal(pooled(*encoder_->merged(*adapter_)), before));
}

TEST_F(LowRankAdapterTest, MergedIsTheSameAsAdded) {
  fill();
  const at::Tensor before = pooled(*encoder_).detach();
  const at::Tensor merged = pooled(*encoder_->merged(*adapter_)).detach();
  encoder_->set_adapter(adapter_);
  const at::Tensor added = pooled(*encoder_).detach();
  EXPECT_TRUE(torch::allclose(added, merged, 1e-4, 1e-5));
  EXPECT_GT((added - before).abs().max().item<double>(), 0.05);
  encoder_->set_adapter(nullptr);
  EXPECT_TRUE(torch::equal(pooled(*encoder_).detach(), before));
}

TEST_F(LowRankAdapterTest, OnlyTheAdapterGetsAGradient) {
  fill();
  encoder_->set_adapter(adapter_);
  pooled(*encoder_).square().sum().backward();
  for (const auto& parameter : adapter_->named_parameters()) {
    ASSERT_TRUE(parameter.value().grad().defined()) << parameter.key();
    EXPECT_GT(parameter.value().grad().abs().max().item<double>(), 0) << parameter.key();
  }
  for (const auto& parameter : encoder_->named_parameters()) {
    EXPECT_FALSE(parameter.value().requires_grad()) << parameter.key();
  }
}

TEST_F(LowRankAdapterTest, IsStoredWithItsEncoder) {
  fill();
  const TestFolder folder;
  const std::string path = folder / "text.safetensors";
  const std::string base = nn::stage_hash(text_);
  nn::save_model(path, {text_, encoders::adapter_stage(*adapter_, base)});
  const auto read = encoders::SentenceEncoder::open(path);
  EXPECT_TRUE(read.has_adapter());
  const at::Tensor expected = pooled(*encoder_->merged(*adapter_)).detach();
  const auto vectors = read.embed({"walk run", "jump kick walk"});
  for (int64_t i = 0; i < 2; ++i) {
    const at::Tensor vector = torch::tensor(vectors[static_cast<size_t>(i)]);
    EXPECT_TRUE(torch::allclose(vector, expected[i] / expected[i].norm(), 1e-4, 1e-5));
  }
  // Another encoder, a rank above the width, half of the tensors.
  nn::ModelStage stage = encoders::adapter_stage(*adapter_, base);
  const auto layers = encoders::bert_linear_layers(config_);
  EXPECT_NO_THROW(encoders::read_adapter(stage, base, layers));
  EXPECT_THROW(encoders::read_adapter(stage, "another", layers), Error);
  stage.config["rank"] = 1000;
  EXPECT_THROW(encoders::read_adapter(stage, base, layers), Error);
  stage.config["rank"] = 4;
  stage.tensors.erase(stage.tensors.begin());
  EXPECT_THROW(encoders::read_adapter(stage, base, layers), Error);
  EXPECT_THROW(encoders::LowRankAdapter({0, 8}, layers), Error);
}

}  // namespace
}  // namespace remomask
