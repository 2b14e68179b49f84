#include "tokenizer/motion_recovery.h"

#include <torch/types.h>

#include <vector>

#include "motion/feature_layout.h"

namespace remomask::tokenizer {

namespace {

// Sum over the frames before each frame: [B, T] -> [B, T].
at::Tensor sum_before(const at::Tensor& x) {
  return torch::constant_pad_nd(x.slice(1, 0, x.size(1) - 1).cumsum(1), {1, 0});
}

}  // namespace

at::Tensor local_positions(const at::Tensor& features, const Skeleton& skeleton) {
  const motion::FeatureLayout layout(skeleton);
  const auto height = features.select(-1, layout.height);
  const auto zero = torch::zeros_like(height);
  const auto root = torch::stack({zero, height, zero}, -1).unsqueeze(2);
  const auto joints = features.slice(-1, layout.positions, layout.rotations)
                          .reshape({features.size(0), features.size(1), layout.joints - 1, 3});
  return torch::cat({root, joints}, 2);
}

at::Tensor recover_positions(const at::Tensor& features, const Skeleton& skeleton) {
  const motion::FeatureLayout layout(skeleton);
  // The yaw column holds half angles; facing turns the world by +angle, so the way back is -angle.
  const auto angle = sum_before(features.select(-1, layout.yaw)) * 2;
  const auto cosine = angle.cos(), sine = angle.sin();
  const auto velocity_x = features.select(-1, layout.root_velocity);
  const auto velocity_z = features.select(-1, layout.root_velocity + 1);
  // The step from frame t to t+1 is given in the facing of t+1.
  const auto next_frame = [](const at::Tensor& x) {
    return torch::cat({x.slice(1, 1), x.slice(1, x.size(1) - 1)}, 1);
  };
  const auto next_cosine = next_frame(cosine), next_sine = next_frame(sine);
  const auto root_x = sum_before(velocity_x * next_cosine - velocity_z * next_sine);
  const auto root_z = sum_before(velocity_x * next_sine + velocity_z * next_cosine);
  const auto local = local_positions(features, skeleton);
  const auto x = local.select(-1, 0), y = local.select(-1, 1), z = local.select(-1, 2);
  const auto c = cosine.unsqueeze(-1), s = sine.unsqueeze(-1);
  return torch::stack(
      {x * c - z * s + root_x.unsqueeze(-1), y, x * s + z * c + root_z.unsqueeze(-1)}, -1);
}

at::Tensor bone_lengths(const at::Tensor& positions, const Skeleton& skeleton) {
  std::vector<int64_t> parents(skeleton.parents.begin() + 1, skeleton.parents.end());
  const auto parent = torch::tensor(parents, torch::kLong).to(positions.device());
  const auto bones = positions.slice(2, 1) - positions.index_select(2, parent);
  // The small term keeps the gradient of a bone without length finite.
  return (bones.square().sum(-1) + 1e-12).sqrt();
}

}  // namespace remomask::tokenizer
