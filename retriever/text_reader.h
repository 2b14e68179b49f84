#pragma once

#include <torch/nn/module.h>
#include <torch/nn/modules/linear.h>

#include <memory>

#include "nn/layers.h"
#include "retriever/config.h"

namespace remomask::retriever {

/// What the retriever learns of a sentence: a transformer over the states that the frozen sentence
/// encoder gives its words, and their mean.
class TextReader final : public torch::nn::Module {
 public:
  /// `tower_width`: of the states.
  TextReader(const RetrieverConfig& config, int64_t tower_width);

  /// states [B, S, tower_width], mask [B, S] bool; returns [B, text_width].
  at::Tensor forward(const at::Tensor& states, const at::Tensor& mask);

 private:
  torch::nn::Linear enter_;
  nn::EncoderStack stack_;
};

}  // namespace remomask::retriever
