#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "encoders/low_rank_adapter.h"
#include "encoders/text_tower.h"
#include "text/bert_wordpiece.h"

namespace remomask::encoders {

/// Sizes and vocabulary of an encoder of the BERT family with learnt positions, token type 0 and
/// mean pooling.
struct BertConfig {
  int64_t width = 384, layers = 6, heads = 12, hidden = 1536;
  int64_t positions = 512;   ///< of the position table
  int64_t max_tokens = 256;  ///< longer texts are cut; at most `positions`
  double norm_epsilon = 1e-12;
  text::BertRules rules;
  std::vector<std::string> vocabulary;
};

void to_json(nlohmann::json& json, const BertConfig& config);
void from_json(const nlohmann::json& json, BertConfig& config);
/// Throws Error for what is missing and for sizes that no encoder has.
BertConfig read_bert_config(const nlohmann::json& json);

/// Names of all weights and their shapes.
std::map<std::string, std::vector<int64_t>> bert_weight_shapes(const BertConfig& config);
/// N(0, 0.02) for matrices and tables from torch's generator, as before any training.
nn::TensorMap random_bert_weights(const BertConfig& config);
/// The layers that an adapter changes: query, key, value, attention output, both of the
/// feed-forward part.
std::vector<LinearSize> bert_linear_layers(const BertConfig& config);

/// Post-norm transformer (Devlin et al. 2019); pooled is the mean of all states, those of [CLS] and
/// [SEP] too.
class BertEncoder final : public TextTower {
 public:
  /// With random weights.
  explicit BertEncoder(const BertConfig& config);
  /// Shares the memory of the weights. Throws Error that begins with `origin` when one is missing,
  /// too many or of another shape.
  BertEncoder(const BertConfig& config, const nn::TensorMap& weights, const std::string& origin);

  TextStates encode(const at::Tensor& ids, const at::Tensor& mask) override;
  at::Tensor encode_below(const at::Tensor& ids, const at::Tensor& mask,
                          int64_t left_out) const override;
  std::shared_ptr<TextTail> tail(int64_t layers) const override;
  TokenBatch tokenize(const std::vector<std::string>& captions) const override;
  int64_t mask_id() const override { return wordpiece_->mask_id(); }
  std::vector<int64_t> special_ids() const override;
  const text::BertWordPiece& wordpiece() const { return *wordpiece_; }
  int64_t width() const override { return config_.width; }
  /// Everything that read_bert_config() needs.
  nlohmann::json config() const;

  /// Any text, an empty one too.
  text::BertTokens read(const std::string& text) const;
  /// Texts that were read, padded to the longest.
  TokenBatch batch(const std::vector<const text::BertTokens*>& texts) const;
  int64_t max_tokens() const { return config_.max_tokens; }

  /// The same encoder with an adapter's changes in its weights. Shares everything else with this
  /// one, tables and vocabulary.
  std::shared_ptr<BertEncoder> merged(const LowRankAdapter& adapter) const;
  /// Adds the adapter's changes to every output from now on and freezes the weights: what is
  /// trained is the adapter. nullptr takes it away again.
  void set_adapter(std::shared_ptr<const LowRankAdapter> adapter);

 private:
  BertEncoder(const BertConfig& config, std::shared_ptr<const text::BertWordPiece> wordpiece,
              const nn::TensorMap& weights, const std::string& origin);
  const at::Tensor& weight(const std::string& name) const { return weights_.at(name); }

  BertConfig config_;  ///< without the vocabulary, which `wordpiece_` holds
  std::shared_ptr<const text::BertWordPiece> wordpiece_;
  nn::TensorMap weights_;  ///< the registered parameters by their full names
  std::shared_ptr<const LowRankAdapter> adapter_;
};

}  // namespace remomask::encoders
