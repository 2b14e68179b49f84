#pragma once

#include <memory>
#include <string>
#include <vector>

#include "encoders/text_tower.h"
#include "retriever/motion_encoder.h"

namespace remomask::retriever {

struct TextVectors {
  at::Tensor states;  ///< [B, S, W]
  at::Tensor query;   ///< [B, E], L2-normalised
  at::Tensor parts;   ///< [B, 6, P]: what the words say about each part, L2-normalised
};

/// The two towers with their heads; what is stored and used after training.
class RetrieverModel final : public torch::nn::Module {
 public:
  /// `config.text_tower` must describe the tower.
  explicit RetrieverModel(const RetrieverConfig& config);

  TextVectors encode_text(const at::Tensor& ids, const at::Tensor& mask);
  encoders::TextTower& text_tower() { return *tower_; }
  const encoders::TextTower& text_tower() const { return *tower_; }
  MotionEncoder& motion_encoder() { return *motion_; }
  const RetrieverConfig& config() const { return config_; }

 private:
  RetrieverConfig config_;
  std::shared_ptr<encoders::TextTower> tower_;
  std::shared_ptr<MotionEncoder> motion_;
  std::shared_ptr<ProjectionHead> text_head_;
  torch::nn::Linear text_parts_;
};

}  // namespace remomask::retriever
