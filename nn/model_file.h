#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "nn/safetensors.h"

namespace torch::nn {
class Module;
}

namespace remomask::nn {

/// One trained network inside a model file.
struct ModelStage {
  std::string kind;       ///< "retriever", "tokenizer", "masked", "residual", "text-encoder", ...
  nlohmann::json config;  ///< everything needed to build it again (preset, sizes, statistics' mode)
  TensorMap tensors;
};

/// Several stages in one safetensors file: tensors are named "kind/name", the
/// configs are in the metadata. `half`: store floating tensors as float16.
void save_model(const std::string& path, const std::vector<ModelStage>& stages, bool half = false);

/// All stages of a model file by kind. Throws FileError when the file is not a
/// remomask model or was made by a newer version.
std::map<std::string, ModelStage> load_model(const std::string& path);

/// The stages named in `kinds`. The tensors of the others are not read: a search needs a fraction
/// of the file. Throws as load_model() and require_stage() do.
std::map<std::string, ModelStage> load_stages(const std::string& path,
                                              const std::vector<std::string>& kinds);

/// load_stages() for one.
ModelStage load_stage(const std::string& path, const std::string& kind);

/// Whether a model file holds a stage of this kind; reads no tensor. Throws as load_model() does.
bool has_stage(const std::string& path, const std::string& kind);

/// The stage of this kind. Throws FileError that names what the model at `path` does hold.
const ModelStage& require_stage(const std::map<std::string, ModelStage>& stages,
                                const std::string& kind, const std::string& path);

/// Identity of the weights and the config.
std::string stage_hash(const ModelStage& stage);

/// Parameters and buffers of a module by name (copies).
TensorMap module_tensors(const torch::nn::Module& module);

/// Sets every parameter and buffer that has a tensor of its name and shape; returns the names of
/// the others, which stay as they are.
std::vector<std::string> load_fitting_tensors(torch::nn::Module& module, const TensorMap& tensors);

/// Sets every parameter and buffer; throws Error when a tensor is missing, too
/// many, or of another shape: nothing is loaded silently.
void load_module_tensors(torch::nn::Module& module, const TensorMap& tensors,
                         const std::string& origin);

}  // namespace remomask::nn
