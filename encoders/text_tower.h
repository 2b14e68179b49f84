#pragma once

#include <torch/nn/module.h>

#include <memory>
#include <string>
#include <vector>

namespace remomask::encoders {

/// Captions as ids, padded to the longest.
struct TokenBatch {
  at::Tensor ids;                ///< [B, S] int64
  at::Tensor mask;               ///< [B, S] bool, true where a token exists
  std::vector<int64_t> dropped;  ///< of each caption: tokens beyond the limit
};

struct TextStates {
  at::Tensor states;  ///< [B, S, W]
  at::Tensor pooled;  ///< [B, W]
};

/// The last layers of a text encoder, as a copy that can be trained.
class TextTail : public torch::nn::Module {
 public:
  /// What encode_below() gave [B, S, W] to the states of the last layer.
  virtual at::Tensor forward(const at::Tensor& states, const at::Tensor& mask) = 0;
};

/// A text encoder with its tokenizer (BERT; DistilBERT and CLIP fit the same interface). A
/// caption's result does not depend on its batch.
class TextTower : public torch::nn::Module {
 public:
  virtual TextStates encode(const at::Tensor& ids, const at::Tensor& mask) = 0;
  /// The states before the last `left_out` layers, which tail(left_out) turns into those of
  /// encode(). Throws Error if there are fewer layers.
  virtual at::Tensor encode_below(const at::Tensor& ids, const at::Tensor& mask,
                                  int64_t left_out) const = 0;
  virtual std::shared_ptr<TextTail> tail(int64_t layers) const = 0;
  /// Captions, read in their canonical form; throws Error for an empty one.
  virtual TokenBatch tokenize(const std::vector<std::string>& captions) const = 0;
  /// Id that stands for a hidden token, for masking in training.
  virtual int64_t mask_id() const = 0;
  /// Ids of tokens that stand for no word, such as those of the beginning and the end.
  virtual std::vector<int64_t> special_ids() const = 0;
  virtual int64_t width() const = 0;
};

}  // namespace remomask::encoders
