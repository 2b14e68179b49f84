#include "training/tokenizer_loss.h"

#include <torch/types.h>

#include <vector>

#include "motion/feature_layout.h"
#include "tokenizer/motion_recovery.h"

namespace remomask::training {

namespace {

at::Tensor frame_steps(const at::Tensor& x) { return x.slice(1, 1) - x.slice(1, 0, x.size(1) - 1); }

}  // namespace

TokenizerLoss::TokenizerLoss(const Skeleton& skeleton, const at::Tensor& mean,
                             const at::Tensor& deviation, const TokenizerLossOptions& options)
    : skeleton_(skeleton),
      mean_(mean.detach().clone()),
      deviation_(deviation.detach().clone()),
      options_(options) {
  const motion::FeatureLayout layout(skeleton);
  column_weights_ = torch::ones({layout.dim});
  column_weights_.slice(0, 0, layout.positions).fill_(options.root);
  column_weights_.slice(0, layout.rotations, layout.velocities).fill_(options.rotations);
  column_weights_.slice(0, layout.velocities, layout.contacts).fill_(options.velocities);
  column_weights_.slice(0, layout.contacts).fill_(options.contacts);
  column_weights_ /= column_weights_.mean();
  column_weights_ = column_weights_.to(mean.device());
  position_unit_ = deviation_.slice(0, layout.positions, layout.rotations).mean().item<double>();
  velocity_unit_ = deviation_.slice(0, layout.velocities, layout.contacts).mean().item<double>();
}

at::Tensor TokenizerLoss::smooth(const at::Tensor& error) const {
  return torch::smooth_l1_loss(error, torch::zeros_like(error), torch::Reduction::None,
                               options_.beta);
}

at::Tensor TokenizerLoss::features_term(const at::Tensor& output, const at::Tensor& target) const {
  return (smooth(output - target) * column_weights_).mean();
}

at::Tensor TokenizerLoss::positions_term(const at::Tensor& output, const at::Tensor& target) const {
  const motion::FeatureLayout layout(skeleton_);
  return smooth((output - target).slice(-1, layout.positions, layout.rotations)).mean();
}

at::Tensor TokenizerLoss::differences_term(const at::Tensor& output,
                                           const at::Tensor& target) const {
  const motion::FeatureLayout layout(skeleton_);
  const auto error = frame_steps((output - target).slice(-1, layout.positions, layout.rotations));
  const auto deviation = deviation_.slice(0, layout.positions, layout.rotations);
  return smooth(error * (deviation / velocity_unit_)).mean();
}

at::Tensor TokenizerLoss::global_term(const at::Tensor& output, const at::Tensor& target) const {
  return smooth((output - target) / position_unit_).mean();
}

at::Tensor TokenizerLoss::foot_speed_term(const at::Tensor& output, const at::Tensor& target,
                                          const at::Tensor& target_contacts) const {
  // Contacts are lax (a foot at 0.8 m/s counts), so the target's own velocity is the aim, not 0.
  std::vector<int64_t> feet(skeleton_.left_feet.begin(), skeleton_.left_feet.end());
  feet.insert(feet.end(), skeleton_.right_feet.begin(), skeleton_.right_feet.end());
  const auto index = torch::tensor(feet, torch::kLong).to(output.device());
  const auto error = frame_steps((output - target).index_select(2, index)) / velocity_unit_;
  const auto contact = target_contacts.slice(1, 0, target_contacts.size(1) - 1);
  return (smooth(error).mean(-1) * contact).sum() / contact.sum().clamp_min(1);
}

at::Tensor TokenizerLoss::bones_term(const at::Tensor& output, const at::Tensor& target) const {
  const auto error =
      tokenizer::bone_lengths(output, skeleton_) - tokenizer::bone_lengths(target, skeleton_);
  return smooth(error / position_unit_).mean();
}

at::Tensor TokenizerLoss::operator()(const at::Tensor& output, const at::Tensor& target) const {
  const auto output_features = output * deviation_ + mean_;
  const auto target_features = target * deviation_ + mean_;
  const auto output_world = tokenizer::recover_positions(output_features, skeleton_);
  const auto target_world = tokenizer::recover_positions(target_features, skeleton_);
  const auto contacts = (target_features.slice(-1, motion::FeatureLayout(skeleton_).contacts) > 0.5)
                            .to(torch::kFloat);
  return features_term(output, target) + options_.positions * positions_term(output, target) +
         options_.differences * differences_term(output, target) +
         options_.global * global_term(output_world, target_world) +
         options_.foot_speed * foot_speed_term(output_world, target_world, contacts) +
         options_.bones * bones_term(output_world, target_world);
}

}  // namespace remomask::training
