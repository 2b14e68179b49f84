#include <fmt/format.h>

#include "base/counted.h"
#include "nn/model_file.h"
#include "tools/core.h"
#include "tools/program.h"

namespace remomask::tools {

namespace {

nlohmann::json describe_model(const std::string& path) {
  nlohmann::json stages = nlohmann::json::object();
  for (const auto& [kind, stage] : nn::load_model(path)) {
    int64_t values = 0;
    for (const auto& [name, tensor] : stage.tensors) values += tensor.numel();
    nlohmann::json config = stage.config;
    if (config.contains("vocabulary")) {
      config["vocabulary"] = fmt::format("{} pieces", config["vocabulary"].size());
    }
    stages[kind] = {{"values", values}, {"hash", nn::stage_hash(stage)}, {"config", config}};
  }
  return {{"file", path}, {"stages", stages}};
}

/// What a person wants to know of a stage: its size, and the sizes that its name stands for.
void print_stage(const std::string& kind, const nlohmann::json& stage) {
  const nlohmann::json& config = stage.at("config");
  fmt::print("  {:<10} {:>10} weights  hash {}", kind, stage.at("values").get<int64_t>(),
             stage.at("hash").get<std::string>().substr(0, 8));
  if (config.contains("preset")) fmt::print("  preset {}", config.at("preset").get<std::string>());
  std::string sizes;
  for (const char* name : {"width", "layers", "heads", "rows", "codes", "levels", "embedding",
                           "max_hits", "vocabulary"}) {
    if (!config.contains(name) || !config.at(name).is_primitive()) continue;
    sizes += fmt::format(
        "{}{} {}", sizes.empty() ? "" : ", ", name,
        config.at(name).is_string() ? config.at(name).get<std::string>() : config.at(name).dump());
  }
  fmt::print("\n{}", sizes.empty() ? "" : "             " + sizes + "\n");
}

}  // namespace

void run_model_info(const std::string& path, Program& program) {
  const nlohmann::json document = describe_model(path);
  if (program.json) return program.print_json(document);
  fmt::print("{}: a model of {}\n", path,
             counted(static_cast<int64_t>(document.at("stages").size()), "stage"));
  for (const auto& [kind, stage] : document.at("stages").items()) print_stage(kind, stage);
  fmt::print("--json prints every setting and how each stage was trained\n");
}

}  // namespace remomask::tools
