#include <CLI/CLI.hpp>

#include "tools/core.h"
#include "tools/database_info.h"
#include "tools/program.h"

namespace remomask::tools {

namespace {

bool is_model_path(const std::string& path) {
  const std::string ending = ".safetensors";
  return path.size() >= ending.size() &&
         path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
}

}  // namespace

void register_info(CLI::App& app, Program& program) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = add_command(app, "info", "say what a database or a model file holds",
                                  "remomask info models/base.safetensors");
  command->add_option("file", *path, "database (.sqlite) or model (.safetensors)")->required();
  command->callback([path, &program] {
    if (is_model_path(*path)) return core(program).model_info(*path, program);
    const auto document = describe_database(*path);
    if (program.json) return program.print_json(document);
    print_description(document);
  });
}

}  // namespace remomask::tools
