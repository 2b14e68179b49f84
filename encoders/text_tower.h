#pragma once

#include <torch/nn/module.h>
#include <torch/nn/modules/embedding.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/preset.h"
#include "nn/layers.h"
#include "text/wordpiece.h"

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

/// A text encoder with its tokenizer. Other towers (CLIP, DistilBERT) fit the
/// same interface. A caption's result does not depend on its batch.
class TextTower : public torch::nn::Module {
 public:
  virtual TextStates encode(const at::Tensor& ids, const at::Tensor& mask) = 0;
  /// Captions of any form; throws Error for an empty one.
  virtual TokenBatch tokenize(const std::vector<std::string>& captions) const = 0;
  /// Id that stands for a hidden token, for masking in training.
  virtual int64_t mask_id() const = 0;
  virtual int64_t width() const = 0;
  /// Everything that make_text_tower() needs.
  virtual nlohmann::json config() const = 0;
};

/// Builds the tower that config() of another one describes, with fresh weights.
std::shared_ptr<TextTower> make_text_tower(const nlohmann::json& config);

struct TextEncoderConfig {
  int64_t width = 256, layers = 4, heads = 4, hidden = 512;
  double dropout = 0.1;
  int64_t max_tokens = 64;
  int64_t vocabulary_size = 2000;       ///< at most, when a vocabulary is learnt
  std::vector<std::string> vocabulary;  ///< WordPiece tokens by id
};

/// Sizes without a vocabulary. MoMask's published sizes go with the base tower.
TextEncoderConfig text_encoder_preset(ModelSize size);

void to_json(nlohmann::json& json, const TextEncoderConfig& config);
void from_json(const nlohmann::json& json, TextEncoderConfig& config);

/// Pre-norm transformer over WordPiece tokens with learned positions, trained
/// from scratch; pooled is the mean of the states.
class TextEncoder final : public TextTower {
 public:
  explicit TextEncoder(const TextEncoderConfig& config);
  TextStates encode(const at::Tensor& ids, const at::Tensor& mask) override;
  TokenBatch tokenize(const std::vector<std::string>& captions) const override;
  int64_t mask_id() const override { return text::WordPiece::kMask; }
  int64_t width() const override { return config_.width; }
  nlohmann::json config() const override;
  const text::WordPiece& wordpiece() const { return wordpiece_; }
  /// [V, W], shared with the masked-word head.
  const at::Tensor& token_weights() const { return tokens_->weight; }

 private:
  TextEncoderConfig config_;
  text::WordPiece wordpiece_;
  torch::nn::Embedding tokens_, positions_;
  nn::EncoderStack stack_;
};

}  // namespace remomask::encoders
