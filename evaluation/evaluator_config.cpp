#include "evaluation/evaluator_config.h"

#include "remomask/error.h"

namespace remomask::evaluation {

EvaluatorConfig evaluator_preset(ModelSize size) {
  EvaluatorConfig config;
  config.preset = size_name(size);
  switch (size) {
    case ModelSize::tiny:
      config.movement_width = 32;
      config.motion_hidden = config.text_hidden = 32;
      config.word_width = 16;
      config.embedding = 16;
      return config;
    case ModelSize::base:
      return config;
    case ModelSize::paper:
      config.movement_width = config.text_hidden = config.embedding = 512;
      config.motion_hidden = 1024;
      config.word_width = 300;
      config.root_weight = 25;
      return config;
    case ModelSize::small:
    case ModelSize::momask:
      break;
  }
  throw Error("there is no evaluator of size \"" + config.preset + "\"; use tiny, base or paper");
}

void to_json(nlohmann::json& json, const EvaluatorConfig& config) {
  json = {{"preset", config.preset},
          {"skeleton", config.skeleton},
          {"mode", motion::feature_mode_name(config.mode)},
          {"movement_width", config.movement_width},
          {"motion_hidden", config.motion_hidden},
          {"text_hidden", config.text_hidden},
          {"word_width", config.word_width},
          {"embedding", config.embedding},
          {"max_words", config.max_words},
          {"max_frames", config.max_frames},
          {"root_weight", config.root_weight},
          {"vocabulary", config.vocabulary}};
}

void from_json(const nlohmann::json& json, EvaluatorConfig& config) {
  json.at("preset").get_to(config.preset);
  json.at("skeleton").get_to(config.skeleton);
  config.mode = motion::parse_feature_mode(json.at("mode").get<std::string>());
  json.at("movement_width").get_to(config.movement_width);
  json.at("motion_hidden").get_to(config.motion_hidden);
  json.at("text_hidden").get_to(config.text_hidden);
  json.at("word_width").get_to(config.word_width);
  json.at("embedding").get_to(config.embedding);
  json.at("max_words").get_to(config.max_words);
  json.at("max_frames").get_to(config.max_frames);
  json.at("root_weight").get_to(config.root_weight);
  json.at("vocabulary").get_to(config.vocabulary);
}

}  // namespace remomask::evaluation
