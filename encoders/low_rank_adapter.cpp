#include "encoders/low_rank_adapter.h"

#include <torch/utils.h>

#include <algorithm>
#include <cmath>

#include "base/json.h"
#include "remomask/error.h"

namespace remomask::encoders {

LowRankAdapter::LowRankAdapter(const AdapterConfig& config, const std::vector<LinearSize>& layers)
    : config_(config) {
  if (config.rank < 1 || !(config.alpha > 0) || !std::isfinite(config.alpha)) {
    throw Error("an adapter needs a rank of at least 1 and a positive alpha");
  }
  for (const LinearSize& layer : layers) {
    std::string name = layer.name;
    std::replace(name.begin(), name.end(), '.', '/');  // names of parameters hold no dot
    const double spread = 1 / std::sqrt(static_cast<double>(layer.inputs));
    Pair& pair = pairs_[layer.name];
    pair.down =
        register_parameter(name + "/down", torch::randn({config.rank, layer.inputs}) * spread);
    pair.up = register_parameter(name + "/up", torch::zeros({layer.outputs, config.rank}));
  }
}

at::Tensor LowRankAdapter::output_change(const std::string& layer, const at::Tensor& inputs) const {
  const Pair& pair = pairs_.at(layer);
  const double scale = config_.alpha / static_cast<double>(config_.rank);
  return torch::linear(torch::linear(inputs, pair.down), pair.up * scale);
}

at::Tensor LowRankAdapter::weight_change(const std::string& layer) const {
  const Pair& pair = pairs_.at(layer);
  return torch::matmul(pair.up, pair.down) * (config_.alpha / static_cast<double>(config_.rank));
}

nn::ModelStage adapter_stage(const LowRankAdapter& adapter, const std::string& base) {
  return {kAdapterStage,
          {{"rank", adapter.config().rank}, {"alpha", adapter.config().alpha}, {"base", base}},
          nn::module_tensors(adapter)};
}

std::shared_ptr<LowRankAdapter> read_adapter(const nn::ModelStage& stage, const std::string& base,
                                             const std::vector<LinearSize>& layers) {
  AdapterConfig config;
  std::string belongs_to;
  try {
    stage.config.at("rank").get_to(config.rank);
    stage.config.at("alpha").get_to(config.alpha);
    stage.config.at("base").get_to(belongs_to);
  } catch (const nlohmann::json::exception& error) {
    throw Error("the text adapter is not described completely: " + json_reason(error));
  }
  if (belongs_to != base) {
    throw Error("the text adapter belongs to the encoder " + belongs_to + ", not to " + base +
                "; put it beside the encoder that it was trained on, or train it again");
  }
  // A file must not choose how much memory is taken: a rank above the width is none of ours.
  for (const LinearSize& layer : layers) {
    if (config.rank > std::min(layer.inputs, layer.outputs)) {
      throw Error("the text adapter's rank " + std::to_string(config.rank) +
                  " is higher than that of its layers");
    }
  }
  auto adapter = std::make_shared<LowRankAdapter>(config, layers);
  nn::load_module_tensors(*adapter, stage.tensors, "text adapter");
  adapter->eval();
  return adapter;
}

}  // namespace remomask::encoders
