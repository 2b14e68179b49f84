#include "nn/model_file.h"

#include <torch/nn/module.h>

#include <algorithm>
#include <functional>

#include "base/hash.h"
#include "base/json.h"
#include "remomask/error.h"

namespace remomask::nn {

namespace {
constexpr int kModelVersion = 1;
constexpr const char* kModelFormat = "remomask-model";

std::string kind_of(const std::string& tensor_name) {
  return tensor_name.substr(0, tensor_name.find('/'));
}

/// Every stage with its config, and with its tensors where `wanted` accepts its kind.
std::map<std::string, ModelStage> read_stages(
    const std::string& path, const std::function<bool(const std::string& kind)>& wanted) {
  // Looks at the header alone first: a foreign file can hold more than the memory.
  auto metadata = load_safetensors(path, [](const std::string&) { return false; }).metadata;
  if (metadata["format"] != kModelFormat) {
    throw FileError(path, 0, "is a safetensors file, but not a remomask model");
  }
  const std::string version = metadata["version"];
  if (version != std::to_string(kModelVersion)) {
    throw FileError(path, 0,
                    "has model version " + version + ", this program reads version " +
                        std::to_string(kModelVersion) + "; use a matching program");
  }
  std::map<std::string, ModelStage> stages;
  try {
    const auto configs = parse_json(metadata["stages"]);
    for (const auto& [kind, config] : configs.items()) {
      stages[kind] = {kind, config, {}};
    }
  } catch (const nlohmann::json::exception& error) {
    throw FileError(path, 0, "broken stage list: " + json_reason(error));
  }
  const TensorFile file =
      load_safetensors(path, [&](const std::string& name) { return wanted(kind_of(name)); });
  for (const auto& [name, tensor] : file.tensors) {
    const size_t slash = name.find('/');
    const auto stage = stages.find(kind_of(name));
    if (slash == std::string::npos || stage == stages.end()) {
      throw FileError(path, 0, "tensor \"" + name + "\" belongs to no stage");
    }
    stage->second.tensors[name.substr(slash + 1)] =
        tensor.scalar_type() == at::kHalf ? tensor.to(at::kFloat) : tensor;
  }
  return stages;
}

}  // namespace

void save_model(const std::string& path, const std::vector<ModelStage>& stages, bool half) {
  TensorMap tensors;
  nlohmann::json configs = nlohmann::json::object();
  for (const ModelStage& stage : stages) {
    configs[stage.kind] = stage.config;
    for (const auto& [name, tensor] : stage.tensors) {
      const bool shrink = half && tensor.scalar_type() == at::kFloat;
      tensors.emplace(stage.kind + "/" + name, shrink ? tensor.to(at::kHalf) : tensor);
    }
  }
  save_safetensors(path, tensors,
                   {{"format", kModelFormat},
                    {"version", std::to_string(kModelVersion)},
                    {"stages", configs.dump()}});
}

std::map<std::string, ModelStage> load_model(const std::string& path) {
  return read_stages(path, [](const std::string&) { return true; });
}

bool has_stage(const std::string& path, const std::string& kind) {
  return read_stages(path, [](const std::string&) { return false; }).contains(kind);
}

std::map<std::string, ModelStage> load_stages(const std::string& path,
                                              const std::vector<std::string>& kinds) {
  const auto stages = read_stages(path, [&](const std::string& kind) {
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  });
  std::map<std::string, ModelStage> found;
  for (const std::string& kind : kinds) found.emplace(kind, require_stage(stages, kind, path));
  return found;
}

ModelStage load_stage(const std::string& path, const std::string& kind) {
  return load_stages(path, {kind}).at(kind);
}

const ModelStage& require_stage(const std::map<std::string, ModelStage>& stages,
                                const std::string& kind, const std::string& path) {
  const auto found = stages.find(kind);
  if (found != stages.end()) return found->second;
  std::string held;
  for (const auto& [name, stage] : stages) held += (held.empty() ? "" : ", ") + name;
  throw FileError(
      path, 0,
      "holds no " + kind + " (it holds: " + held + "); train it first, or name another model");
}

std::string stage_hash(const ModelStage& stage) {
  std::string digest = stage.kind + stage.config.dump();
  for (const auto& [name, tensor] : stage.tensors) {
    const at::Tensor data = tensor.detach().to(at::kCPU).contiguous();
    digest += name + content_hash({static_cast<const char*>(data.data_ptr()), data.nbytes()});
  }
  return content_hash(digest);
}

TensorMap module_tensors(const torch::nn::Module& module) {
  TensorMap tensors;
  for (const auto& item : module.named_parameters()) {
    tensors[item.key()] = item.value().detach().clone();
  }
  for (const auto& item : module.named_buffers()) {
    tensors[item.key()] = item.value().detach().clone();
  }
  return tensors;
}

std::vector<std::string> load_fitting_tensors(torch::nn::Module& module, const TensorMap& tensors) {
  at::NoGradGuard no_grad;
  std::vector<std::string> left;
  const auto load = [&](const std::string& name, at::Tensor target) {
    const auto found = tensors.find(name);
    if (found != tensors.end() && found->second.sizes() == target.sizes()) {
      target.copy_(found->second);
    } else {
      left.push_back(name);
    }
  };
  for (auto& item : module.named_parameters()) load(item.key(), item.value());
  for (auto& item : module.named_buffers()) load(item.key(), item.value());
  return left;
}

void load_module_tensors(torch::nn::Module& module, const TensorMap& tensors,
                         const std::string& origin) {
  at::NoGradGuard no_grad;
  size_t used = 0;
  const auto load = [&](const std::string& name, at::Tensor target) {
    const auto found = tensors.find(name);
    if (found == tensors.end()) throw Error(origin + ": tensor \"" + name + "\" is missing");
    if (found->second.sizes() != target.sizes()) {
      throw Error(origin + ": tensor \"" + name + "\" has another shape than this configuration");
    }
    target.copy_(found->second);
    ++used;
  };
  for (auto& item : module.named_parameters()) load(item.key(), item.value());
  for (auto& item : module.named_buffers()) load(item.key(), item.value());
  if (used != tensors.size()) {
    throw Error(origin + ": has " + std::to_string(tensors.size() - used) +
                " tensors that this configuration does not know");
  }
}

}  // namespace remomask::nn
