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
      config.text_width = 64;
      config.text_layers = 1;
      config.text_heads = 2;
      config.text_hidden = 128;
      break;
    case ModelSize::small:
      config.width = 64;
      config.layers = 2;
      config.hidden = 128;
      config.embedding = 128;
      config.part_embedding = 32;
      config.text_width = 128;
      config.text_hidden = 256;
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
      config.text_width = 512;
      config.text_layers = 4;
      config.text_heads = 8;
      config.text_hidden = 1024;
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

RetrieverConfig read_retriever_config(const nlohmann::json& json) {
  if (json.contains("text_tower")) {
    throw Error(
        "the model was trained by version 0.2 or older, whose retriever had a text encoder of its "
        "own; train it again, or use the model of this version");
  }
  return json.get<RetrieverConfig>();
}

}  // namespace remomask::retriever
