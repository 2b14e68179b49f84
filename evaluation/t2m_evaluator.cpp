#include "evaluation/t2m_evaluator.h"

#include <array>

#include "base/json.h"
#include "evaluation/evaluator_config.h"
#include "remomask/error.h"

namespace remomask::evaluation {

namespace {

/// Names in the file and in our network, where they differ.
constexpr std::array<std::array<const char*, 2>, 3> kRenamed = {
    {{"mean", "mean"}, {"std", "deviation"}, {"word_vectors", "word_embedding.weight"}}};

}  // namespace

bool is_t2m_evaluator(const nn::TensorFile& file) {
  return file.metadata.count("format") == 0 &&
         file.tensors.count("movement_encoder.main.0.weight") > 0;
}

nn::ModelStage import_t2m_evaluator(const nn::TensorFile& file, const std::string& path) {
  EvaluatorConfig config = evaluator_preset(ModelSize::paper);
  config.mode = motion::FeatureMode::official;
  const auto words = file.metadata.find("vocabulary");
  if (words == file.metadata.end()) {
    throw FileError(path, 0, "lacks the word list \"vocabulary\" in its metadata");
  }
  try {
    config.vocabulary = parse_json(words->second).get<std::vector<std::string>>();
  } catch (const nlohmann::json::exception&) {
    throw FileError(path, 0, "\"vocabulary\" in its metadata is no JSON list of words");
  }
  nn::ModelStage stage;
  stage.kind = "evaluator";
  stage.tensors = file.tensors;
  for (const auto& [name, own] : kRenamed) {
    auto tensor = stage.tensors.extract(name);
    if (tensor.empty()) throw FileError(path, 0, std::string("lacks the tensor ") + name);
    tensor.key() = own;
    stage.tensors.insert(std::move(tensor));
  }
  for (auto& [name, tensor] : stage.tensors) tensor = tensor.to(at::kFloat);
  if (stage.tensors.at("mean").numel() == kit_skeleton().feature_dim()) {
    config.skeleton = kit_skeleton().name;
  }
  stage.config = config;
  return stage;
}

}  // namespace remomask::evaluation
