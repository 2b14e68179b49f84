#include <fmt/format.h>

#include <map>

#include "base/error.h"
#include "db/database.h"
#include "nn/model_file.h"
#include "tools/program.h"

namespace remomask {

namespace {

bool is_model_path(const std::string& path) {
  const std::string ending = ".safetensors";
  return path.size() >= ending.size() &&
         path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

nlohmann::json describe_model(const std::string& path) {
  nlohmann::json stages = nlohmann::json::object();
  for (const auto& [kind, stage] : load_model(path)) {
    int64_t values = 0;
    for (const auto& [name, tensor] : stage.tensors) values += tensor.numel();
    nlohmann::json config = stage.config;
    if (config.contains("vocabulary")) {
      config["vocabulary"] = fmt::format("{} pieces", config["vocabulary"].size());
    }
    stages[kind] = {{"values", values}, {"hash", stage_hash(stage)}, {"config", config}};
  }
  return {{"file", path}, {"stages", stages}};
}

nlohmann::json describe_database(const std::string& path) {
  const Database database(path, OpenMode::read_only);
  std::map<std::string, int> splits, sources, licences;
  size_t captions = 0;
  double seconds = 0;
  const auto clips = database.clips();
  for (const Clip& clip : clips) {
    ++splits[clip.split];
    ++sources[clip.source];
    ++licences[clip.licence];
    captions += clip.captions.size();
    seconds += clip.frames / 20.0;
  }
  return {{"file", path},          {"uuid", database.uuid()}, {"generation", database.generation()},
          {"clips", clips.size()}, {"captions", captions},    {"minutes", seconds / 60},
          {"splits", splits},      {"sources", sources},      {"licences", licences}};
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
    for (const auto& [key, value] : document.items()) {
      if (value.is_object()) {
        fmt::print("{}:\n", key);
        for (const auto& [name, entry] : value.items()) {
          fmt::print("  {:<12} {}\n", name.empty() ? "(unknown)" : name, entry.dump());
        }
      } else {
        fmt::print("{:<12} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
      }
    }
  });
}

}  // namespace remomask
