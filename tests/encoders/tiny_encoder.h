#pragma once

#include <string>

#include "encoders/bert_encoder.h"
#include "encoders/sentence_encoder.h"
#include "nn/model_file.h"

namespace remomask {

/// A sentence encoder with random weights that reads the words that are given, and letters.
inline nn::ModelStage tiny_encoder_stage(const std::vector<std::string>& words) {
  encoders::BertConfig config;
  config.width = 32;
  config.layers = 2;
  config.heads = 2;
  config.hidden = 64;
  config.positions = config.max_tokens = 32;
  config.vocabulary = {"[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]"};
  config.vocabulary.insert(config.vocabulary.end(), words.begin(), words.end());
  nn::TensorMap weights = encoders::random_bert_weights(config);
  // As published ones are: words differ by more than the norms level out.
  weights["words"] = weights["words"] * 50;
  return {encoders::kTextEncoderStage, config, std::move(weights)};
}

}  // namespace remomask
