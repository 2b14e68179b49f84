#include "retriever/config.h"

#include "remomask/error.h"

namespace remomask::retriever {

Queues parse_queues(const std::string& name) {
  for (const Queues queues : {Queues::none, Queues::motion, Queues::text, Queues::both}) {
    if (name == queues_name(queues)) return queues;
  }
  throw Error("there is no choice of queues '" + name + "'; use none, motion, text or both");
}

const char* queues_name(Queues queues) {
  switch (queues) {
    case Queues::none:
      return "none";
    case Queues::motion:
      return "motion";
    case Queues::text:
      return "text";
    case Queues::both:
      break;
  }
  return "both";
}

RetrieverConfig retriever_preset(ModelSize size) {
  RetrieverConfig config;
  switch (size) {
    case ModelSize::tiny:
      config.width = 32;
      config.layers = 1;
      config.heads = 2;
      config.hidden = 64;
      config.embedding = 64;
      config.part_embedding = 16;
      break;
    case ModelSize::small:
      config.width = 64;
      config.layers = 2;
      config.hidden = 128;
      config.embedding = 128;
      config.part_embedding = 32;
      break;
    case ModelSize::base:
    case ModelSize::momask:
      return config;
    case ModelSize::paper:
      config.patch = 1;
      config.width = 512;
      config.layers = 4;
      config.hidden = 1024;
      config.dropout = 0.5;
      config.embedding = 512;
      break;
  }
  config.preset = size_name(size);
  return config;
}

void use_whole_body_encoder(RetrieverConfig& config) {
  config.encoders = 1;
  // Weights of a block grow with the square of the width: (5/2)^2 is about six.
  config.width = config.width * 5 / 2;
  config.hidden = config.hidden * 5 / 2;
}

void to_json(nlohmann::json& json, const RetrieverConfig& config) {
  json = {{"preset", config.preset},
          {"skeleton", config.skeleton},
          {"mode", motion::feature_mode_name(config.mode)},
          {"patch", config.patch},
          {"width", config.width},
          {"layers", config.layers},
          {"heads", config.heads},
          {"hidden", config.hidden},
          {"dropout", config.dropout},
          {"embedding", config.embedding},
          {"part_embedding", config.part_embedding},
          {"encoders", config.encoders},
          {"text_tower", config.text_tower}};
}

void from_json(const nlohmann::json& json, RetrieverConfig& config) {
  json.at("preset").get_to(config.preset);
  json.at("skeleton").get_to(config.skeleton);
  config.mode = motion::parse_feature_mode(json.at("mode").get<std::string>());
  json.at("patch").get_to(config.patch);
  json.at("width").get_to(config.width);
  json.at("layers").get_to(config.layers);
  json.at("heads").get_to(config.heads);
  json.at("hidden").get_to(config.hidden);
  json.at("dropout").get_to(config.dropout);
  json.at("embedding").get_to(config.embedding);
  json.at("part_embedding").get_to(config.part_embedding);
  // Files of earlier versions do not say it.
  config.encoders = json.value("encoders", config.encoders);
  config.text_tower = json.at("text_tower");
}

}  // namespace remomask::retriever
