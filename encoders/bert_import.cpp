#include "encoders/bert_import.h"

#include <torch/utils.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "base/bounded_file.h"
#include "base/json.h"
#include "encoders/bert_encoder.h"
#include "encoders/sentence_encoder.h"
#include "nn/safetensors.h"
#include "remomask/error.h"

namespace remomask::encoders {

namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMostConfigBytes = 16u << 20;
constexpr int64_t kUsualTokens = 256;
constexpr double kLargestHalf = 65504;

/// A JSON file of the folder; errors name it and the key.
class ConfigFile {
 public:
  /// A file that is not there is an empty object, unless it is `required`.
  ConfigFile(const std::string& folder, const std::string& name, bool required = false)
      : path_((fs::path(folder) / name).string()), json_(nlohmann::json::object()) {
    if (!required && !fs::exists(path_)) return;
    try {
      json_ = parse_json(read_bounded_file(path_, kMostConfigBytes));
    } catch (const nlohmann::json::exception& error) {
      throw FileError(path_, 0, "is no JSON: " + json_reason(error));
    }
  }

  const std::string& path() const { return path_; }
  const nlohmann::json& json() const { return json_; }

  template <typename T>
  T at(const std::string& key) const {
    try {
      return json_.at(key).get<T>();
    } catch (const nlohmann::json::exception& error) {
      throw FileError(path_, 0, "\"" + key + "\": " + json_reason(error));
    }
  }
  /// `otherwise` if the key is missing or null.
  template <typename T>
  T value(const std::string& key, const T& otherwise) const {
    const bool given = json_.is_object() && json_.contains(key) && !json_[key].is_null();
    return given ? at<T>(key) : otherwise;
  }

  void require(const std::string& key, const std::string& expected) const {
    const auto found = value<std::string>(key, expected);
    if (found != expected) {
      throw FileError(
          path_, 0,
          "\"" + key + "\" is \"" + found + "\", and only \"" + expected + "\" is computed here");
    }
  }

 private:
  std::string path_;
  nlohmann::json json_;
};

void check_pooling(const std::string& folder) {
  const ConfigFile pooling(folder, "1_Pooling/config.json");
  for (const auto& [key, value] : pooling.json().items()) {
    if (!key.starts_with("pooling_mode_") || !pooling.at<bool>(key)) continue;
    if (key != "pooling_mode_mean_tokens") {
      throw FileError(pooling.path(), 0,
                      "\"" + key + "\" is set, and only the mean of all tokens is computed here");
    }
  }
  if (pooling.value("pooling_mode_mean_tokens", true)) return;
  throw FileError(pooling.path(), 0,
                  "\"pooling_mode_mean_tokens\" is not set, and only the mean of "
                  "all tokens is computed here");
}

/// What follows the transformer may be its pooling and a division by the length.
void check_modules(const std::string& folder) {
  const ConfigFile modules(folder, "modules.json");
  for (const auto& module : modules.json()) {
    const std::string type = module.is_object() ? module.value("type", "") : "";
    if (!type.ends_with(".Transformer") && !type.ends_with(".Pooling") &&
        !type.ends_with(".Normalize")) {
      throw FileError(modules.path(), 0,
                      "the module \"" + type +
                          "\" is not computed here; only Transformer, Pooling "
                          "and Normalize are");
    }
  }
}

text::BertRules read_rules(const std::string& folder) {
  const ConfigFile tokenizer(folder, "tokenizer_config.json");
  const ConfigFile sentences(folder, "sentence_bert_config.json");
  if (!tokenizer.value("tokenize_chinese_chars", true)) {
    throw FileError(tokenizer.path(), 0,
                    "\"tokenize_chinese_chars\" is false, which is not computed here");
  }
  text::BertRules rules;
  rules.lower_case = tokenizer.value("do_lower_case", true);
  rules.strip_accents = tokenizer.value("strip_accents", rules.lower_case);
  rules.lower_case = rules.lower_case || sentences.value("do_lower_case", false);
  return rules;
}

BertConfig read_hub_config(const std::string& folder, const BertImportOptions& options) {
  const ConfigFile file(folder, "config.json", /*required=*/true);
  file.require("model_type", "bert");
  file.require("hidden_act", "gelu");
  file.require("position_embedding_type", "absolute");
  BertConfig config;
  config.width = file.at<int64_t>("hidden_size");
  config.layers = file.at<int64_t>("num_hidden_layers");
  config.heads = file.at<int64_t>("num_attention_heads");
  config.hidden = file.at<int64_t>("intermediate_size");
  config.positions = file.at<int64_t>("max_position_embeddings");
  config.norm_epsilon = file.value("layer_norm_eps", 1e-12);
  config.rules = read_rules(folder);
  const std::string vocabulary = (fs::path(folder) / "vocab.txt").string();
  config.vocabulary = text::read_bert_vocabulary(vocabulary);
  const auto stated = file.at<int64_t>("vocab_size");
  if (stated != static_cast<int64_t>(config.vocabulary.size())) {
    throw FileError(vocabulary, 0,
                    "has " + std::to_string(config.vocabulary.size()) +
                        " lines, and config.json "
                        "says \"vocab_size\": " +
                        std::to_string(stated));
  }
  config.max_tokens = std::min(
      config.positions,
      options.max_tokens.value_or(
          ConfigFile(folder, "sentence_bert_config.json").value("max_seq_length", kUsualTokens)));
  try {
    read_bert_config(config);
  } catch (const Error& error) {
    throw FileError(file.path(), 0, error.what());
  }
  try {
    text::BertWordPiece(config.vocabulary);
  } catch (const Error& error) {
    throw FileError(vocabulary, 0, error.what());
  }
  return config;
}

/// The published name of a weight, by ours.
std::string published_name(const std::string& own) {
  static const std::map<std::string, std::string> kTables = {
      {"words", "embeddings.word_embeddings.weight"},
      {"positions", "embeddings.position_embeddings.weight"},
      {"type", "embeddings.token_type_embeddings.weight"},
      {"norm.weight", "embeddings.LayerNorm.weight"},
      {"norm.bias", "embeddings.LayerNorm.bias"}};
  static const std::map<std::string, std::string> kLayers = {
      {"query", "attention.self.query"},
      {"key", "attention.self.key"},
      {"value", "attention.self.value"},
      {"attention_output", "attention.output.dense"},
      {"attention_norm", "attention.output.LayerNorm"},
      {"expand", "intermediate.dense"},
      {"contract", "output.dense"},
      {"output_norm", "output.LayerNorm"}};
  const auto table = kTables.find(own);
  if (table != kTables.end()) return table->second;
  const size_t layer = own.find('.') + 1, kind = own.rfind('.');  // "block0.query.weight"
  const size_t digits = std::string("block").size();
  return "encoder.layer." + own.substr(digits, layer - digits) +
         kLayers.at(own.substr(layer, kind - layer)) + own.substr(kind);
}

/// Tensors without a part in the states: heads of the tasks of pretraining, and a list 0, 1, 2, ...
bool is_not_needed(const std::string& name) {
  return name.starts_with("pooler.") || name.starts_with("cls.") ||
         name == "embeddings.position_ids";
}

std::string weights_path(const std::string& folder) {
  for (const char* name : {"model.safetensors", "model_f16.safetensors"}) {
    const fs::path path = fs::path(folder) / name;
    if (fs::exists(path)) return path.string();
  }
  throw FileError(folder, 0,
                  "holds neither model.safetensors nor model_f16.safetensors; other formats of "
                  "weights, or weights in several files, must be converted first");
}

/// One weight as we store it: float32, of the shape that the config says.
at::Tensor own_weight(at::Tensor value, const std::string& own, const std::vector<int64_t>& shape,
                      const std::function<void(const std::string&)>& fail) {
  if (!value.is_floating_point()) fail("holds no floating-point numbers");
  if (own == "type" && value.dim() == 2 && value.size(0) > 0) value = value[0];  // of any text
  if (value.sizes() != at::IntArrayRef(shape)) fail("has another shape than config.json says");
  value = value.to(at::kFloat).contiguous();
  if (!(value.abs().max().item<double>() <= kLargestHalf)) {
    fail("holds a number that is not finite, or too large for half precision");
  }
  return value;
}

nn::TensorMap own_weights(const std::string& path, const BertConfig& config,
                          const nn::TensorMap& published) {
  nn::TensorMap tensors;
  for (const auto& [name, tensor] : published) {
    const std::string plain = name.starts_with("bert.") ? name.substr(5) : name;
    if (is_not_needed(plain)) continue;
    if (!tensors.emplace(plain, tensor).second) {
      throw FileError(path, 0, "tensor \"" + plain + "\" is there with and without \"bert.\"");
    }
  }
  nn::TensorMap weights;
  for (const auto& [own, shape] : bert_weight_shapes(config)) {
    const std::string name = published_name(own);
    const auto fail = [&](const std::string& what) {
      throw FileError(path, 0, "tensor \"" + name + "\" " + what);
    };
    const auto found = tensors.find(name);
    if (found == tensors.end()) {
      fail("is missing");
    } else {
      weights[own] = own_weight(found->second, own, shape, fail);
      tensors.erase(found);
    }
  }
  if (tensors.empty()) return weights;
  throw FileError(
      path, 0,
      "tensor \"" + tensors.begin()->first + "\" belongs to no encoder that config.json describes");
}

}  // namespace

nn::ModelStage import_bert(const std::string& folder, const BertImportOptions& options) {
  if (!fs::is_directory(folder)) throw FileError(folder, 0, "is no folder");
  const BertConfig config = read_hub_config(folder, options);
  check_modules(folder);
  check_pooling(folder);
  const std::string path = weights_path(folder);
  nn::TensorFile file = nn::load_safetensors(path);
  nn::ModelStage stage{kTextEncoderStage, config, own_weights(path, config, file.tensors)};
  stage.config["licence"] = !options.licence.empty()             ? options.licence
                            : file.metadata.count("license") > 0 ? file.metadata["license"]
                                                                 : "unknown";
  stage.config["origin"] = file.metadata["source"];
  return stage;
}

}  // namespace remomask::encoders
