#include "retriever/motion_encoder.h"

#include <gtest/gtest.h>
#include <torch/utils.h>

#include <limits>

#include "nn/layers.h"
#include "remomask/error.h"
#include "retriever/packed_attention.h"
#include "tests/retriever/retriever_test_tools.h"

namespace remomask {
namespace {

TEST(PackedAttention, AgreesWithPlainAttentionAndItsGradient) {
  torch::manual_seed(1);
  const std::vector<int64_t> offsets = {0, 3, 4, 9};
  at::Tensor packed = torch::randn({2, 9, 3 * 8}).requires_grad_(true);
  const at::Tensor upper = torch::randn({2, 9, 8});
  const at::Tensor result = retriever::packed_attention(packed, offsets, 2);
  (result * upper).sum().backward();
  const at::Tensor gradient = packed.grad().clone();
  packed.mutable_grad() = at::Tensor();

  std::vector<at::Tensor> rows;
  for (size_t b = 0; b + 1 < offsets.size(); ++b) {
    const auto parts = packed.slice(1, offsets[b], offsets[b + 1]).chunk(3, 2);
    rows.push_back(nn::multi_head_attention(parts[0], parts[1], parts[2], {}, 2));
  }
  const at::Tensor expected = torch::cat(rows, 1);
  EXPECT_TRUE(torch::allclose(result, expected, 1e-5, 1e-5));
  (expected * upper).sum().backward();
  EXPECT_TRUE(torch::allclose(gradient, packed.grad(), 1e-4, 1e-5));
}

TEST(MotionEncoder, ResultDoesNotDependOnTheBatch) {
  at::NoGradGuard no_grad;
  torch::manual_seed(1);
  retriever::MotionEncoder encoder(tiny_retriever_config());
  encoder.eval();
  const motion::Features a = random_features(196, 1), b = random_features(21, 2),
                         c = random_features(4, 3);
  const auto all = encoder.forward(encoder.patches(
      {retriever::whole_clip(a), retriever::whole_clip(b), retriever::whole_clip(c)}));
  const std::vector<const motion::Features*> clips = {&a, &b, &c};
  for (int64_t i = 0; i < 3; ++i) {
    const auto one =
        encoder.forward(encoder.patches({retriever::whole_clip(*clips[static_cast<size_t>(i)])}));
    EXPECT_TRUE(torch::allclose(one.global[0], all.global[i], 1e-4, 1e-4));
    EXPECT_TRUE(torch::allclose(one.parts[0], all.parts[i], 1e-4, 1e-4));
  }
  EXPECT_TRUE(torch::allclose(all.global.norm(2, 1), torch::ones({3}), 1e-5, 1e-5));
  EXPECT_TRUE(torch::allclose(all.parts.norm(2, 2), torch::ones({3, 6}), 1e-5, 1e-5));
}

TEST(MotionEncoder, LastPartialPatchRepeatsTheLastFrame) {
  retriever::MotionEncoder encoder(tiny_retriever_config());
  const motion::Features five = random_features(5, 1);
  motion::Features eight(8, 263);
  for (int t = 0; t < 8; ++t) std::copy_n(five.row(std::min(t, 4)), 263, eight.row(t));
  EXPECT_TRUE(encoder.patches({retriever::whole_clip(five)})
                  .patches.equal(encoder.patches({retriever::whole_clip(eight)}).patches));
}

TEST(MotionEncoder, StatisticsNormaliseTheTrainingMotions) {
  retriever::MotionEncoder encoder(tiny_retriever_config());
  motion::Features clip(8, 263);
  for (int t = 0; t < 8; ++t) {
    for (int c = 0; c < 263; ++c) clip.row(t)[c] = static_cast<float>(c + (t % 2 ? 2 : -2));
  }
  encoder.set_statistics({&clip});
  const auto patches = encoder.patches({retriever::whole_clip(clip)}).patches;
  // Part 0 has 50 columns: frame 0 of the first patch is -1 in all of them.
  EXPECT_TRUE(torch::allclose(patches[0][1].slice(0, 0, 50), torch::full({50}, -1.f)));
  EXPECT_TRUE(torch::allclose(patches[0][1].slice(0, 50, 100), torch::full({50}, 1.f)));
}

TEST(MotionEncoder, CropsKeepEnoughAndRepeat) {
  const motion::Features clip = random_features(40, 1);
  for (uint64_t seed = 0; seed < 50; ++seed) {
    CounterRandom random(seed), again(seed);
    const retriever::MotionCrop crop = retriever::random_crop(clip, 0.7, 0.5, 4, random);
    EXPECT_GE(crop.frames, 28);
    EXPECT_LE(crop.first + crop.frames, 40);
    ASSERT_FALSE(crop.kept.empty());
    EXPECT_LT(crop.kept.back() * 4, crop.frames);
    EXPECT_EQ(retriever::random_crop(clip, 0.7, 0.5, 4, again).kept, crop.kept);
  }
}

TEST(MotionEncoder, RefusesWhatItCannotRead) {
  retriever::MotionEncoder encoder(tiny_retriever_config());
  const motion::Features short_clip(3, 263), foreign(10, 251);
  motion::Features broken(10, 263);
  broken.row(3)[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(encoder.patches({retriever::whole_clip(short_clip)}), Error);
  EXPECT_THROW(encoder.patches({retriever::whole_clip(foreign)}), Error);
  EXPECT_THROW(encoder.patches({retriever::whole_clip(broken)}), Error);
}

TEST(MotionEncoder, KeepsTokensApartAtTheStart) {
  at::NoGradGuard no_grad;
  torch::manual_seed(1);
  const retriever::RetrieverConfig config = retriever::retriever_preset(ModelSize::base);
  retriever::MotionEncoder encoder(config);
  const motion::Features clip = random_features(196, 1);
  for (const at::Tensor& states :
       encoder.block_states(encoder.patches({retriever::whole_clip(clip)}))) {
    // Share of the energy that differs between the tokens of a sequence.
    const at::Tensor centred = states - states.mean(1, true);
    const double share =
        centred.square().sum().item<double>() / states.square().sum().item<double>();
    EXPECT_GT(share, 1e-2);
  }
}

TEST(MotionEncoder, OneEncoderReadsTheWholeBody) {
  torch::manual_seed(1);
  retriever::RetrieverConfig config = tiny_retriever_config();
  retriever::use_whole_body_encoder(config);
  retriever::MotionEncoder encoder(config);
  const motion::Features a = random_features(40, 1);
  const retriever::PatchBatch patches = encoder.patches({retriever::whole_clip(a)});
  // All 263 columns of the 4 frames of a patch, and the mark of the start token.
  EXPECT_EQ(patches.patches.sizes(), (std::vector<int64_t>{1, 11, 4 * 263 + 1}));
  const retriever::MotionVectors vectors = encoder.forward(patches);
  EXPECT_EQ(vectors.parts.sizes(), (std::vector<int64_t>{1, 6, config.part_embedding}));
  EXPECT_GT((vectors.parts[0][0] - vectors.parts[0][1]).abs().max().item<float>(), 1e-3f);
  (vectors.global.sum() + vectors.parts.square().sum()).backward();
  for (const auto& item : encoder.named_parameters()) {
    EXPECT_TRUE(item.value().grad().defined()) << item.key();
  }
  config.encoders = 3;
  EXPECT_THROW(retriever::MotionEncoder{config}, Error);
}

// The ablation is about where the weights are, not about how many there are.
TEST(MotionEncoder, OneEncoderHasAboutAsManyWeightsAsSix) {
  const auto weights = [](const retriever::RetrieverConfig& config) {
    int64_t count = 0;
    for (const auto& parameter : retriever::MotionEncoder(config).parameters())
      count += parameter.numel();
    return static_cast<double>(count);
  };
  for (const ModelSize size : {ModelSize::small, ModelSize::base}) {
    retriever::RetrieverConfig config = retriever::retriever_preset(size);
    const double six = weights(config);
    retriever::use_whole_body_encoder(config);
    EXPECT_NEAR(weights(config) / six, 1, 0.2) << size_name(size);
    EXPECT_EQ(nlohmann::json(config).get<retriever::RetrieverConfig>().encoders, 1);
  }
}

TEST(MotionEncoder, KitHasItsOwnParts) {
  retriever::RetrieverConfig config = tiny_retriever_config();
  config.skeleton = "kit";
  retriever::MotionEncoder encoder(config);
  motion::Features clip(12, 251);
  EXPECT_EQ(encoder.forward(encoder.patches({retriever::whole_clip(clip)})).global.size(0), 1);
}

}  // namespace
}  // namespace remomask
