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

}  // namespace remomask::evaluation
