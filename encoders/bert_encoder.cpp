#include "encoders/bert_encoder.h"

#include <torch/utils.h>

#include <algorithm>
#include <cmath>

#include "base/json.h"
#include "nn/layers.h"
#include "remomask/error.h"
#include "text/caption.h"

namespace remomask::encoders {

namespace {

constexpr const char* kBertTower = "bert";
constexpr const char* kMeanPooling = "mean";
constexpr int64_t kLargestSize = 1 << 20, kMostBlocks = 1000;

std::string block_name(int64_t number) { return "block" + std::to_string(number) + "."; }

void check_bert_config(const BertConfig& config) {
  const auto bad = [](const std::string& what) {
    throw Error("the text encoder's config is impossible: " + what);
  };
  for (const int64_t size : {config.width, config.heads, config.hidden, config.positions}) {
    if (size < 1 || size > kLargestSize) bad("a size of " + std::to_string(size));
  }
  if (config.layers < 1 || config.layers > kMostBlocks) {
    bad(std::to_string(config.layers) + " layers");
  }
  if (config.width % config.heads != 0) {
    bad("a width of " + std::to_string(config.width) + " is not divided by " +
        std::to_string(config.heads) + " heads");
  }
  if (config.max_tokens < 3 || config.max_tokens > config.positions) {
    bad("at most " + std::to_string(config.max_tokens) + " tokens with " +
        std::to_string(config.positions) + " positions");
  }
  if (!(config.norm_epsilon > 0) || !(config.norm_epsilon < 1)) bad("its layer norm epsilon");
  if (config.vocabulary.empty()) bad("an empty vocabulary");
}

/// A weight as it is registered: "block0.query.weight" in the module block0.query.
void register_weight(torch::nn::Module& root, const std::string& name, const at::Tensor& value) {
  torch::nn::Module* module = &root;
  size_t begin = 0;
  for (size_t dot = name.find('.'); dot != std::string::npos; dot = name.find('.', begin)) {
    const std::string part = name.substr(begin, dot - begin);
    const auto children = module->named_children();
    const std::shared_ptr<torch::nn::Module>* child = children.find(part);
    module = child != nullptr
                 ? child->get()
                 : module->register_module(part, std::make_shared<torch::nn::Module>()).get();
    begin = dot + 1;
  }
  module->register_parameter(name.substr(begin), value);
}

void check_layers(const BertConfig& config, int64_t last) {
  if (last >= 0 && last <= config.layers) return;
  throw Error("the text encoder has " + std::to_string(config.layers) + " layers, not " +
              std::to_string(last));
}

/// The blocks of an encoder, or of its tail, over their weights.
struct Blocks {
  const BertConfig& config;
  const nn::TensorMap& weights;
  const LowRankAdapter* adapter = nullptr;

  at::Tensor linear(const std::string& layer, const at::Tensor& x) const {
    const at::Tensor y =
        torch::linear(x, weights.at(layer + ".weight"), weights.at(layer + ".bias"));
    return adapter != nullptr ? y + adapter->output_change(layer, x) : y;
  }

  at::Tensor norm(const std::string& layer, const at::Tensor& x) const {
    return torch::layer_norm(x, {config.width}, weights.at(layer + ".weight"),
                             weights.at(layer + ".bias"), config.norm_epsilon);
  }

  at::Tensor block(int64_t number, const at::Tensor& x, const at::Tensor& bias) const {
    const std::string name = block_name(number);
    const at::Tensor attended =
        nn::multi_head_attention(linear(name + "query", x), linear(name + "key", x),
                                 linear(name + "value", x), bias, config.heads);
    const at::Tensor y =
        norm(name + "attention_norm", x + linear(name + "attention_output", attended));
    return norm(name + "output_norm",
                y + linear(name + "contract", torch::gelu(linear(name + "expand", y))));
  }
};

class BertTail final : public TextTail {
 public:
  BertTail(const BertConfig& config, nn::TensorMap weights, int64_t layers)
      : config_(config), weights_(std::move(weights)), layers_(layers) {
    for (const auto& [name, value] : weights_) register_weight(*this, name, value);
    for (const auto& parameter : named_parameters()) weights_[parameter.key()] = parameter.value();
  }

  at::Tensor forward(const at::Tensor& states, const at::Tensor& mask) override {
    const Blocks blocks{config_, weights_};
    const at::Tensor bias = nn::key_mask_bias(mask);
    at::Tensor x = states;
    for (int64_t i = config_.layers - layers_; i < config_.layers; ++i) {
      x = blocks.block(i, x, bias);
    }
    return x;
  }

 private:
  BertConfig config_;  // without the vocabulary
  nn::TensorMap weights_;
  int64_t layers_;
};

}  // namespace

void to_json(nlohmann::json& json, const BertConfig& config) {
  json = {{"tower", kBertTower},
          {"width", config.width},
          {"layers", config.layers},
          {"heads", config.heads},
          {"hidden", config.hidden},
          {"positions", config.positions},
          {"max_tokens", config.max_tokens},
          {"norm_epsilon", config.norm_epsilon},
          {"pooling", kMeanPooling},
          {"lower_case", config.rules.lower_case},
          {"strip_accents", config.rules.strip_accents},
          {"vocabulary", config.vocabulary}};
}

void from_json(const nlohmann::json& json, BertConfig& config) {
  json.at("width").get_to(config.width);
  json.at("layers").get_to(config.layers);
  json.at("heads").get_to(config.heads);
  json.at("hidden").get_to(config.hidden);
  json.at("positions").get_to(config.positions);
  json.at("max_tokens").get_to(config.max_tokens);
  json.at("norm_epsilon").get_to(config.norm_epsilon);
  json.at("lower_case").get_to(config.rules.lower_case);
  json.at("strip_accents").get_to(config.rules.strip_accents);
  json.at("vocabulary").get_to(config.vocabulary);
}

BertConfig read_bert_config(const nlohmann::json& json) {
  BertConfig config;
  std::string tower, pooling;
  try {
    tower = json.at("tower");
    json.get_to(config);
    pooling = json.at("pooling");
  } catch (const nlohmann::json::exception& error) {
    throw Error("the text encoder is not described completely: " + json_reason(error));
  }
  if (tower != kBertTower) {
    throw Error("the text encoder \"" + tower + "\" is unknown; this program knows " + kBertTower);
  }
  if (pooling != kMeanPooling) {
    throw Error("the text encoder's pooling \"" + pooling + "\" is unknown; this program knows " +
                kMeanPooling);
  }
  check_bert_config(config);
  return config;
}

std::vector<LinearSize> bert_linear_layers(const BertConfig& config) {
  std::vector<LinearSize> layers;
  for (int64_t i = 0; i < config.layers; ++i) {
    for (const char* name : {"query", "key", "value", "attention_output"}) {
      layers.push_back({block_name(i) + name, config.width, config.width});
    }
    layers.push_back({block_name(i) + "expand", config.width, config.hidden});
    layers.push_back({block_name(i) + "contract", config.hidden, config.width});
  }
  return layers;
}

std::map<std::string, std::vector<int64_t>> bert_weight_shapes(const BertConfig& config) {
  std::map<std::string, std::vector<int64_t>> shapes = {
      {"words", {static_cast<int64_t>(config.vocabulary.size()), config.width}},
      {"positions", {config.positions, config.width}},
      {"type", {config.width}}};
  const auto add = [&](const std::string& layer, const std::vector<int64_t>& shape) {
    shapes[layer + ".weight"] = shape;
    shapes[layer + ".bias"] = {shape.front()};
  };
  add("norm", {config.width});
  for (const LinearSize& layer : bert_linear_layers(config)) {
    add(layer.name, {layer.outputs, layer.inputs});
  }
  for (int64_t i = 0; i < config.layers; ++i) {
    add(block_name(i) + "attention_norm", {config.width});
    add(block_name(i) + "output_norm", {config.width});
  }
  return shapes;
}

nn::TensorMap random_bert_weights(const BertConfig& config) {
  nn::TensorMap weights;
  for (const auto& [name, shape] : bert_weight_shapes(config)) {
    const bool norm_weight = shape.size() == 1 && name.ends_with(".weight");
    weights[name] = norm_weight         ? torch::ones(shape)
                    : shape.size() == 1 ? torch::zeros(shape)
                                        : torch::randn(shape) * 0.02;
  }
  return weights;
}

BertEncoder::BertEncoder(const BertConfig& config)
    : BertEncoder(config, random_bert_weights(config), "random text encoder") {}

BertEncoder::BertEncoder(const BertConfig& config, const nn::TensorMap& weights,
                         const std::string& origin)
    : BertEncoder(config, std::make_shared<text::BertWordPiece>(config.vocabulary, config.rules),
                  weights, origin) {}

BertEncoder::BertEncoder(const BertConfig& config,
                         std::shared_ptr<const text::BertWordPiece> wordpiece,
                         const nn::TensorMap& weights, const std::string& origin)
    : config_(config), wordpiece_(std::move(wordpiece)) {
  config_.vocabulary = wordpiece_->vocabulary();
  check_bert_config(config_);
  const auto shapes = bert_weight_shapes(config_);
  for (const auto& [name, shape] : shapes) {
    const auto found = weights.find(name);
    if (found == weights.end()) throw Error(origin + ": tensor \"" + name + "\" is missing");
    if (found->second.sizes() != at::IntArrayRef(shape) ||
        found->second.scalar_type() != at::kFloat) {
      throw Error(origin + ": tensor \"" + name + "\" has another shape or type than its config");
    }
    const at::Tensor value = found->second.detach();
    register_weight(*this, name, value);
    weights_[name] = value;
  }
  for (const auto& [name, tensor] : weights) {
    if (shapes.count(name) == 0) throw Error(origin + ": tensor \"" + name + "\" is unknown");
  }
  config_.vocabulary.clear();
}

nlohmann::json BertEncoder::config() const {
  BertConfig whole = config_;
  whole.vocabulary = wordpiece_->vocabulary();
  return whole;
}

std::vector<int64_t> BertEncoder::special_ids() const {
  return {wordpiece_->pad_id(), wordpiece_->start_id(), wordpiece_->end_id(),
          wordpiece_->mask_id()};
}

text::BertTokens BertEncoder::read(const std::string& text) const {
  return wordpiece_->encode(text, config_.max_tokens);
}

TokenBatch BertEncoder::batch(const std::vector<const text::BertTokens*>& texts) const {
  TokenBatch batch;
  size_t longest = 1;
  for (const text::BertTokens* text : texts) {
    longest = std::max(longest, text->ids.size());
    batch.dropped.push_back(text->dropped);
  }
  const auto count = static_cast<int64_t>(texts.size());
  const auto columns = static_cast<int64_t>(longest);
  batch.ids = torch::full({count, columns}, wordpiece_->pad_id(), torch::kLong);
  batch.mask = torch::zeros({count, columns}, torch::kBool);
  for (int64_t i = 0; i < count; ++i) {
    const std::vector<int64_t>& ids = texts[static_cast<size_t>(i)]->ids;
    std::copy(ids.begin(), ids.end(), batch.ids.data_ptr<int64_t>() + i * columns);
    std::fill_n(batch.mask.data_ptr<bool>() + i * columns, ids.size(), true);
  }
  return batch;
}

TokenBatch BertEncoder::tokenize(const std::vector<std::string>& captions) const {
  std::vector<text::BertTokens> read_texts;
  for (const std::string& caption : captions) {
    read_texts.push_back(read(text::normalise_prompt(caption)));
  }
  std::vector<const text::BertTokens*> texts;
  for (const text::BertTokens& text : read_texts) texts.push_back(&text);
  return batch(texts);
}

TextStates BertEncoder::encode(const at::Tensor& ids, const at::Tensor& mask) {
  const at::Tensor x = encode_below(ids, mask, 0);
  const at::Tensor share = mask.to(x.scalar_type()).unsqueeze(2);
  return {x, (x * share).sum(1) / share.sum(1)};
}

at::Tensor BertEncoder::encode_below(const at::Tensor& ids, const at::Tensor& mask,
                                     int64_t left_out) const {
  check_layers(config_, left_out);
  const Blocks blocks{config_, weights_, adapter_.get()};
  at::Tensor x = torch::embedding(weight("words"), ids) +
                 weight("positions").slice(0, 0, ids.size(1)) + weight("type");
  x = blocks.norm("norm", x);
  const at::Tensor bias = nn::key_mask_bias(mask);
  for (int64_t i = 0; i < config_.layers - left_out; ++i) x = blocks.block(i, x, bias);
  return x;
}

std::shared_ptr<TextTail> BertEncoder::tail(int64_t layers) const {
  check_layers(config_, layers);
  nn::TensorMap weights;
  for (int64_t i = config_.layers - layers; i < config_.layers; ++i) {
    for (const auto& [name, value] : weights_) {
      if (name.starts_with(block_name(i))) weights[name] = value.detach().clone();
    }
  }
  return std::make_shared<BertTail>(config_, std::move(weights), layers);
}

std::shared_ptr<BertEncoder> BertEncoder::merged(const LowRankAdapter& adapter) const {
  at::NoGradGuard no_grad;
  nn::TensorMap weights = weights_;
  for (const LinearSize& layer : bert_linear_layers(config_)) {
    at::Tensor& changed = weights.at(layer.name + ".weight");
    changed = changed + adapter.weight_change(layer.name);
  }
  // The constructor is private, so that std::make_shared cannot call it.
  return std::shared_ptr<BertEncoder>(
      new BertEncoder(config_, wordpiece_, weights, "merged text encoder"));
}

void BertEncoder::set_adapter(std::shared_ptr<const LowRankAdapter> adapter) {
  adapter_ = std::move(adapter);
  if (!adapter_) return;
  for (at::Tensor& parameter : parameters()) parameter.set_requires_grad(false);
}

}  // namespace remomask::encoders
