#pragma once

#include <ATen/core/Tensor.h>

#include <nlohmann/json.hpp>

#include "remomask/skeleton.h"

namespace remomask::training {

/// Weights of the reconstruction loss. All terms are smooth L1 of errors in
/// units of the training set's standard deviations.
struct TokenizerLossOptions {
  double beta = 0.2;  ///< where smooth L1 turns from quadratic to linear
  double root = 4.0;  ///< weight of yaw and root velocity, height (MoMask: a factor in the std)
  double rotations = 0.5;  ///< weight of the 6D rotations; nothing is exported from them
  double velocities = 0.5;
  double contacts = 1.0;
  double positions = 0.5;    ///< extra position term (MoMask's second term)
  double differences = 0.5;  ///< velocities of the positions against those of the target
  double global = 0.3;       ///< joints in the world, root path integrated over the window
  double foot_speed = 0.2;   ///< world velocity of the feet where the target touches the ground
  double bones = 0.2;        ///< bone lengths
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TokenizerLossOptions, beta, root, rotations, velocities,
                                   contacts, positions, differences, global, foot_speed, bones)

/// Reconstruction loss of the tokenizer (MoMask eq. 4 without commitment, and
/// the terms above).
class TokenizerLoss {
 public:
  /// mean, deviation [D] of the normalisation.
  TokenizerLoss(const Skeleton& skeleton, const at::Tensor& mean, const at::Tensor& deviation,
                const TokenizerLossOptions& options);

  /// Normalised features [B, T, D], T >= 2 -> scalar.
  at::Tensor operator()(const at::Tensor& output, const at::Tensor& target) const;

  /// The terms of the sum above, without their weights.
  at::Tensor features_term(const at::Tensor& output, const at::Tensor& target) const;
  at::Tensor positions_term(const at::Tensor& output, const at::Tensor& target) const;
  at::Tensor differences_term(const at::Tensor& output, const at::Tensor& target) const;
  /// These take world positions [B, T, J, 3].
  at::Tensor global_term(const at::Tensor& output, const at::Tensor& target) const;
  at::Tensor foot_speed_term(const at::Tensor& output, const at::Tensor& target,
                             const at::Tensor& target_contacts) const;
  at::Tensor bones_term(const at::Tensor& output, const at::Tensor& target) const;

 private:
  at::Tensor smooth(const at::Tensor& error) const;

  const Skeleton& skeleton_;
  at::Tensor mean_, deviation_;
  at::Tensor column_weights_;             ///< [D], mean 1
  double position_unit_, velocity_unit_;  ///< mean std of the groups
  TokenizerLossOptions options_;
};

}  // namespace remomask::training
