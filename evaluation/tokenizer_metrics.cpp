#include "evaluation/tokenizer_metrics.h"

#include <torch/types.h>

#include "base/time.h"
#include "tokenizer/length_batches.h"
#include "tokenizer/motion_recovery.h"

namespace remomask::evaluation {

namespace {

constexpr double kMillimetres = 1000;
constexpr double kStandingSpeed = 0.005;  // of the original's foot, a frame
constexpr size_t kMetricBatch = 64;

}  // namespace

ReconstructionSums::ReconstructionSums(const Skeleton& skeleton)
    : skeleton_(skeleton), feet_(skeleton.left_feet.begin(), skeleton.left_feet.end()) {
  feet_.insert(feet_.end(), skeleton.right_feet.begin(), skeleton.right_feet.end());
}

void ReconstructionSums::add(const at::Tensor& output, const at::Tensor& target) {
  frames_ += static_cast<double>(output.size(0) * output.size(1));
  const auto joint_error = [](const at::Tensor& error) {
    return error.norm(2, -1).mean(-1).sum().item<double>();
  };
  mpjpe_ += joint_error((output - output.slice(2, 0, 1)) - (target - target.slice(2, 0, 1)));
  global_ += joint_error(output - target);
  const auto bone_error =
      tokenizer::bone_lengths(output, skeleton_) - tokenizer::bone_lengths(target, skeleton_);
  bones_ += bone_error.abs().mean(-1).sum().item<double>();
  const auto index = torch::tensor(feet_, torch::kLong);
  const auto steps = [&](const at::Tensor& positions) {
    const auto feet = positions.index_select(2, index);
    return feet.slice(1, 1) - feet.slice(1, 0, feet.size(1) - 1);
  };
  const auto standing = (steps(target).norm(2, -1) < kStandingSpeed).to(torch::kFloat);
  const auto across = steps(output).index_select(-1, torch::tensor({0, 2})).norm(2, -1);
  skate_ += (across * standing).sum().item<double>();
  standing_ += standing.sum().item<double>();
}

ReconstructionErrors ReconstructionSums::errors() const {
  ReconstructionErrors result;
  if (frames_ > 0) {
    result.mpjpe = kMillimetres * mpjpe_ / frames_;
    result.global_mpjpe = kMillimetres * global_ / frames_;
    result.bone_length = kMillimetres * bones_ / frames_;
  }
  if (standing_ > 0) result.foot_skate = kMillimetres * skate_ / standing_;
  return result;
}

TokenizerMetrics measure_tokenizer(tokenizer::TokenizerNetwork& network,
                                   const std::vector<const motion::Features*>& clips) {
  at::NoGradGuard no_grad;
  const tokenizer::TokenizerConfig& config = network->config();
  const Skeleton& skeleton = network->skeleton();
  const int64_t groups = network->quantizer()->options().groups;
  ReconstructionSums all(skeleton), base(skeleton);
  TokenizerMetrics metrics;
  auto hits = torch::zeros({config.levels, groups, config.codes}, torch::kDouble);
  for (const tokenizer::LengthBatch& batch :
       tokenizer::batches_by_length(clips, kFramesPerToken, kMetricBatch)) {
    const auto features = tokenizer::stack_batch(clips, batch);
    const auto target = tokenizer::recover_positions(features, skeleton);
    const auto tokens = network->tokens(network->normalise(features));
    const auto decoded = [&](int64_t levels) {
      return tokenizer::recover_positions(
          network->denormalise(network->from_tokens(tokens.slice(-1, 0, levels))), skeleton);
    };
    all.add(decoded(config.levels), target);
    base.add(decoded(1), target);
    metrics.clips += features.size(0);
    metrics.frames += features.size(0) * features.size(1);
    for (int64_t level = 0; level < config.levels; ++level) {
      for (int64_t group = 0; group < groups; ++group) {
        const auto level_tokens = tokens.select(-1, level);
        const auto used = groups == 1 ? level_tokens : level_tokens.select(-1, group);
        hits[level][group] += torch::bincount(used.flatten(), {}, config.codes);
      }
    }
  }
  metrics.all_levels = all.errors();
  metrics.base_level = base.errors();
  for (int64_t level = 0; level < config.levels; ++level) {
    metrics.code_use.push_back((hits[level] > 0).to(torch::kDouble).mean().item<double>());
    const auto share = hits[level] / hits[level].sum(-1, true).clamp_min(1);
    const auto entropy = -(share * share.clamp_min(1e-12).log()).sum(-1);
    metrics.perplexity.push_back(entropy.exp().mean().item<double>());
  }
  return metrics;
}

std::vector<const motion::Features*> clip_features(const std::vector<db::TrainingClip>& clips) {
  std::vector<const motion::Features*> features;
  for (const db::TrainingClip& clip : clips) features.push_back(&clip.features);
  return features;
}

}  // namespace remomask::evaluation
