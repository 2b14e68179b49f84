#pragma once

#include <torch/nn/module.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "nn/model_file.h"

namespace remomask::encoders {

/// A linear layer that an adapter changes.
struct LinearSize {
  std::string name;
  int64_t inputs = 0, outputs = 0;
};

struct AdapterConfig {
  int64_t rank = 16;
  double alpha = 32;  ///< the change is scaled by alpha / rank
};

/// Low-rank changes of linear layers (LoRA, Hu et al. 2021): W + alpha / rank * up down. Its
/// parameters are all that is trained and stored; the weights below stay as they are.
class LowRankAdapter final : public torch::nn::Module {
 public:
  /// Random `down`, from torch's generator, and zero `up`: it changes nothing yet. Throws Error if
  /// rank or alpha is not positive.
  LowRankAdapter(const AdapterConfig& config, const std::vector<LinearSize>& layers);

  /// What is added to the layer's output for inputs [..., inputs].
  at::Tensor output_change(const std::string& layer, const at::Tensor& inputs) const;
  /// What is added to the layer's weight [outputs, inputs].
  at::Tensor weight_change(const std::string& layer) const;
  const AdapterConfig& config() const { return config_; }

 private:
  struct Pair {
    at::Tensor down, up;
  };
  AdapterConfig config_;
  std::map<std::string, Pair> pairs_;
};

inline constexpr const char* kAdapterStage = "text-adapter";

/// The stage of an adapter that belongs to the encoder of this stage_hash().
nn::ModelStage adapter_stage(const LowRankAdapter& adapter, const std::string& base);

/// Throws Error when the stage belongs to an encoder other than `base`, or does not fit `layers`.
std::shared_ptr<LowRankAdapter> read_adapter(const nn::ModelStage& stage, const std::string& base,
                                             const std::vector<LinearSize>& layers);

}  // namespace remomask::encoders
