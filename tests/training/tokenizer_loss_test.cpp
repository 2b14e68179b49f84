#include "training/tokenizer_loss.h"

#include <gtest/gtest.h>
#include <torch/torch.h>

#include "motion/feature_layout.h"
#include "tests/tokenizer/tokenizer_test_tools.h"
#include "tokenizer/motion_recovery.h"

namespace remomask {
namespace {

class TokenizerLossTest : public ::testing::Test {
 protected:
  TokenizerLossTest() {
    options_.beta = 1;
    mean_ = torch::zeros({263});
    deviation_ = torch::ones({263});
  }
  training::TokenizerLoss loss() const { return {skeleton_, mean_, deviation_, options_}; }
  at::Tensor target() const {
    return torch::tensor(swinging_features(12, 2).values).view({1, 12, 263});
  }

  const Skeleton& skeleton_ = humanml_skeleton();
  at::Tensor mean_, deviation_;
  training::TokenizerLossOptions options_;
};

TEST_F(TokenizerLossTest, NothingForAPerfectCopy) {
  EXPECT_EQ(loss()(target(), target()).item<double>(), 0);
}

TEST_F(TokenizerLossTest, ColumnsAreWeighted) {
  options_.root = 3;
  options_.rotations = options_.velocities = options_.contacts = 1;
  auto output = target();
  output.select(-1, 0) += 0.5;  // smooth L1 with beta 1: 0.125
  const double mean_weight = (263 + 2 * 4) / 263.0;
  EXPECT_NEAR(loss().features_term(output, target()).item<double>(), 0.125 * 3 / mean_weight / 263,
              1e-7);
}

TEST_F(TokenizerLossTest, PositionsAndTheirDifferences) {
  auto output = target();
  output.select(-1, 4) += 2;  // smooth L1: 1.5, in one of 63 columns
  EXPECT_NEAR(loss().positions_term(output, target()).item<double>(), 1.5 / 63, 1e-6);
  EXPECT_NEAR(loss().differences_term(output, target()).item<double>(), 0, 1e-9);
  output = target();
  output[0][6][4] += 2;  // two of 11 steps are wrong by 2
  EXPECT_NEAR(loss().differences_term(output, target()).item<double>(), 2 * 1.5 / (63 * 11), 1e-6);
}

TEST_F(TokenizerLossTest, GlobalPositionsSeeTheRootPath) {
  auto output = target();
  output[0][0][2] += 0.5;  // one step forward too long: all later frames are 0.5 off in a plane
  const auto a = tokenizer::recover_positions(output, skeleton_),
             b = tokenizer::recover_positions(target(), skeleton_);
  EXPECT_NEAR((a - b).norm(2, -1).slice(1, 1).mean().item<double>(), 0.5, 1e-5);
  EXPECT_NEAR((a - b)[0][0].abs().sum().item<double>(), 0, 1e-6);
  // |error|^2 / 2 summed over axes, over three axes, 11 of 12 frames.
  EXPECT_NEAR(loss().global_term(a, b).item<double>(), 0.125 / 3 * 11 / 12, 1e-6);
}

TEST_F(TokenizerLossTest, FeetCountOnlyInContact) {
  const auto b = tokenizer::recover_positions(target(), skeleton_);
  auto a = b.clone();
  a[0].select(1, 7).select(1, 0) += torch::arange(12) * 0.1;  // left ankle slides 0.1 a frame
  auto contacts = torch::zeros({1, 12, 4});
  EXPECT_EQ(loss().foot_speed_term(a, b, contacts).item<double>(), 0);
  contacts.select(-1, 0).fill_(1);
  EXPECT_NEAR(loss().foot_speed_term(a, b, contacts).item<double>(), 0.5 * 0.01 / 3, 1e-6);
  contacts.zero_().select(-1, 2).fill_(1);  // the right ankle is right
  EXPECT_EQ(loss().foot_speed_term(a, b, contacts).item<double>(), 0);
}

TEST_F(TokenizerLossTest, BonesAreMeasured) {
  const auto b = tokenizer::recover_positions(target(), skeleton_);
  EXPECT_NEAR(loss().bones_term(b * 2, b).item<double>(),
              (0.5 * tokenizer::bone_lengths(b, skeleton_).square()).mean().item<double>(), 1e-6);
  EXPECT_NEAR(loss().bones_term(b + 3, b).item<double>(), 0, 1e-9);
}

TEST_F(TokenizerLossTest, GradientsAreDifferences) {
  // Central differences in double along random directions.
  torch::manual_seed(8);
  mean_ = torch::randn({263}, torch::kDouble) * 0.1;
  deviation_ = torch::rand({263}, torch::kDouble) + 0.5;
  options_.beta = 0.3;
  const auto right = target().to(torch::kDouble);
  const training::TokenizerLoss total(skeleton_, mean_, deviation_, options_);
  auto output = (right + 0.2 * torch::randn_like(right)).requires_grad_();
  total(output, right).backward();
  for (int i = 0; i < 5; ++i) {
    const auto direction = torch::randn_like(right);
    const double step = 1e-5;
    const auto at = [&](double scale) {
      return total(output.detach() + scale * direction, right).item<double>();
    };
    const double expected = (output.grad() * direction).sum().item<double>();
    EXPECT_NEAR((at(step) - at(-step)) / (2 * step), expected, 1e-4 * (1 + std::abs(expected)));
  }
}

}  // namespace
}  // namespace remomask
