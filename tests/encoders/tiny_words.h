#pragma once

#include <torch/utils.h>

#include <memory>
#include <string>

#include "encoders/bert_encoder.h"
#include "encoders/sentence_encoder.h"
#include "nn/model_file.h"

namespace remomask {

/// A small sentence encoder with random weights and pieces for every lower-case English text.
inline const nn::ModelStage& tiny_text_stage() {
  static const nn::ModelStage stage = [] {
    encoders::BertConfig config;
    config.width = 32;
    config.layers = 2;
    config.heads = 2;
    config.hidden = 64;
    config.positions = config.max_tokens = 64;
    config.vocabulary = {"[PAD]",   "[UNK]", "[CLS]", "[SEP]",  "[MASK]", "person",
                         "someone", "walks", "runs",  "slowly", "waves",  "jumps"};
    for (char c = ' ' + 1; c <= '~'; ++c) {
      if (c >= 'A' && c <= 'Z') continue;
      config.vocabulary.push_back({c});
      config.vocabulary.push_back(std::string("##") + c);
    }
    torch::manual_seed(11);
    return nn::ModelStage{encoders::kTextEncoderStage, config,
                          encoders::random_bert_weights(config)};
  }();
  return stage;
}

inline const std::shared_ptr<const encoders::SentenceEncoder>& tiny_words() {
  static const auto words =
      std::make_shared<const encoders::SentenceEncoder>(encoders::SentenceEncoder::of_stages(
          {{encoders::kTextEncoderStage, tiny_text_stage()}}, "tiny"));
  return words;
}

}  // namespace remomask
