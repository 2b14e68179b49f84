#include "tests/evaluation/evaluator_test_tools.h"

#include <torch/utils.h>

#include "evaluation/evaluator_network.h"
#include "tests/retriever/retriever_test_tools.h"

namespace remomask {

EvaluatorConfig tiny_evaluator_config() {
  EvaluatorConfig config = evaluator_preset("tiny");
  std::vector<std::string> captions;
  for (const TrainingClip& clip : separable_clips(24, 2, 1)) captions.push_back(clip.captions[0]);
  config.vocabulary = evaluator_vocabulary(captions);
  return config;
}

ModelStage untrained_evaluator_stage(uint64_t seed) {
  torch::manual_seed(seed);
  const EvaluatorConfig config = tiny_evaluator_config();
  return {"evaluator", config, module_tensors(*EvaluatorNetwork(config))};
}

}  // namespace remomask
