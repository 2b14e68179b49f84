#include <fmt/format.h>

#include "nn/model_file.h"
#include "tools/database_info.h"
#include "tools/program.h"

namespace remomask::tools {

namespace {

bool is_model_path(const std::string& path) {
  const std::string ending = ".safetensors";
  return path.size() >= ending.size() &&
         path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

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

}  // namespace

void register_info(CLI::App& app, Program& program) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = add_command(app, "info", "say what a database or a model file holds",
                                  "remomask info models/base.safetensors");
  command->add_option("file", *path, "database (.sqlite) or model (.safetensors)")->required();
  command->callback([path, &program] {
    const auto document = is_model_path(*path) ? describe_model(*path) : describe_database(*path);
    if (program.json) return program.print_json(document);
    print_description(document);
  });
}

}  // namespace remomask::tools
