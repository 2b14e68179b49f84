#include "training/start_weights.h"

#include <torch/nn/module.h>

#include "remomask/error.h"

namespace remomask::training {

nlohmann::json start_from(torch::nn::Module& module, const std::optional<nn::ModelStage>& start) {
  if (!start) return nlohmann::json::object();
  const std::vector<std::string> anew = nn::load_fitting_tensors(module, start->tensors);
  if (anew.size() == module.parameters().size() + module.buffers().size()) {
    throw Error("no weight of the " + start->kind +
                " that the training should go on from fits; choose its preset");
  }
  return {{"from", nn::stage_hash(*start)}, {"anew", anew}};
}

}  // namespace remomask::training
