#pragma once

#include <memory>
#include <string>
#include <vector>

#include "encoders/text_tower.h"
#include "retriever/motion_encoder.h"
#include "retriever/projection.h"
#include "retriever/text_reader.h"

namespace remomask::retriever {

struct TextVectors {
  at::Tensor states;  ///< [B, S, W] of the sentence encoder
  at::Tensor query;   ///< [B, E], L2-normalised
  at::Tensor parts;   ///< [B, 6, P]: what the words say about each part, L2-normalised
};

/// What is trained and stored of a retriever: the text reader over the states of a sentence
/// encoder, the motion encoder, and the heads of both. The sentence encoder is neither trained nor
/// stored here, but shared; of its last config.tuned_text_layers layers there is a copy that is.
class RetrieverModel final : public torch::nn::Module {
 public:
  /// `tower` must have config.text_encoder_width; it is only read.
  RetrieverModel(const RetrieverConfig& config, std::shared_ptr<encoders::TextTower> tower);

  /// No gradient flows into the sentence encoder itself.
  TextVectors encode_text(const at::Tensor& ids, const at::Tensor& mask);
  /// The same from frozen_states().
  TextVectors read_states(const at::Tensor& frozen, const at::Tensor& mask);
  /// States below config.tuned_text_layers [B, S, W], without gradient.
  at::Tensor frozen_states(const at::Tensor& ids, const at::Tensor& mask) const;
  const encoders::TextTower& text_tower() const { return *tower_; }
  MotionEncoder& motion_encoder() { return *motion_; }
  const RetrieverConfig& config() const { return config_; }

 private:
  RetrieverConfig config_;
  std::shared_ptr<encoders::TextTower> tower_;  // not registered: no part of this module
  std::shared_ptr<encoders::TextTail> tail_;    // none: the sentence encoder as it is
  std::shared_ptr<TextReader> reader_;
  std::shared_ptr<MotionEncoder> motion_;
  std::shared_ptr<ProjectionHead> text_head_;
  torch::nn::Linear text_parts_;
};

}  // namespace remomask::retriever
