#include "encoders/text_tower.h"

#include <algorithm>

#include "encoders/bert_encoder.h"
#include "remomask/error.h"
#include "text/caption.h"

namespace remomask::encoders {

TextEncoderConfig text_encoder_preset(ModelSize size) {
  TextEncoderConfig config;
  switch (size) {
    case ModelSize::tiny:
      config.width = 64;
      config.layers = 2;
      config.heads = 2;
      config.hidden = 128;
      config.vocabulary_size = 600;
      break;
    case ModelSize::small:
      config.width = 128;
      config.layers = 2;
      config.heads = 4;
      config.hidden = 256;
      config.vocabulary_size = 1000;
      break;
    case ModelSize::base:
    case ModelSize::momask:
      break;
    case ModelSize::paper:
      config.width = 768;
      config.layers = 6;
      config.heads = 12;
      config.hidden = 3072;
      config.vocabulary_size = 8000;
      break;
  }
  return config;
}

void to_json(nlohmann::json& json, const TextEncoderConfig& config) {
  json = {{"tower", "wordpiece_transformer"}, {"width", config.width},
          {"layers", config.layers},          {"heads", config.heads},
          {"hidden", config.hidden},          {"dropout", config.dropout},
          {"max_tokens", config.max_tokens},  {"vocabulary", config.vocabulary}};
}

void from_json(const nlohmann::json& json, TextEncoderConfig& config) {
  json.at("width").get_to(config.width);
  json.at("layers").get_to(config.layers);
  json.at("heads").get_to(config.heads);
  json.at("hidden").get_to(config.hidden);
  json.at("dropout").get_to(config.dropout);
  json.at("max_tokens").get_to(config.max_tokens);
  json.at("vocabulary").get_to(config.vocabulary);
  config.vocabulary_size = static_cast<int64_t>(config.vocabulary.size());
}

std::shared_ptr<TextTower> make_text_tower(const nlohmann::json& config) {
  const std::string tower = config.value("tower", "");
  if (tower != "wordpiece_transformer" && tower != "bert") {
    throw Error(
        "the model's text tower '" + tower +
        "' is unknown; this program knows wordpiece_transformer and bert, a newer one may know "
        "more");
  }
  try {
    if (tower == "bert") return std::make_shared<BertEncoder>(read_bert_config(config));
    return std::make_shared<TextEncoder>(config.get<TextEncoderConfig>());
  } catch (const nlohmann::json::exception& error) {
    throw Error(std::string("the model's text tower is not described completely: ") + error.what());
  }
}

TextEncoder::TextEncoder(const TextEncoderConfig& config)
    : config_(config),
      wordpiece_(config.vocabulary),
      tokens_(register_module("tokens", torch::nn::Embedding(wordpiece_.size(), config.width))),
      positions_(
          register_module("positions", torch::nn::Embedding(config.max_tokens, config.width))),
      stack_(register_module("stack", nn::EncoderStack(config.layers, config.width, config.heads,
                                                       config.hidden, config.dropout))) {
  nn::initialise_transformer_weights(*tokens_);
  nn::initialise_transformer_weights(*positions_);
  nn::initialise_transformer_weights(*stack_);
}

nlohmann::json TextEncoder::config() const { return config_; }

TokenBatch TextEncoder::tokenize(const std::vector<std::string>& captions) const {
  std::vector<text::TokenizedCaption> tokenized;
  int64_t longest = 1;
  TokenBatch batch;
  for (const std::string& caption : captions) {
    tokenized.push_back(wordpiece_.encode(text::normalise_prompt(caption), config_.max_tokens));
    longest = std::max(longest, static_cast<int64_t>(tokenized.back().ids.size()));
    batch.dropped.push_back(tokenized.back().dropped);
  }
  const auto count = static_cast<int64_t>(captions.size());
  batch.ids = torch::full({count, longest}, text::WordPiece::kPad, torch::kLong);
  for (int64_t i = 0; i < count; ++i) {
    const auto& ids = tokenized[static_cast<size_t>(i)].ids;
    std::copy(ids.begin(), ids.end(), batch.ids.data_ptr<int64_t>() + i * longest);
  }
  batch.mask = batch.ids.ne(text::WordPiece::kPad);
  return batch;
}

TextStates TextEncoder::encode(const at::Tensor& ids, const at::Tensor& mask) {
  const auto positions =
      torch::arange(ids.size(1), torch::TensorOptions(torch::kLong).device(ids.device()));
  const auto states = stack_(tokens_(ids) + positions_(positions), mask);
  const auto weight = mask.to(states.scalar_type()).unsqueeze(2);
  return {states, (states * weight).sum(1) / weight.sum(1)};
}

}  // namespace remomask::encoders
