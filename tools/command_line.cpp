#include <CLI/CLI.hpp>

#include "tools/program.h"

namespace remomask::tools {

CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& summary,
                      const std::string& example) {
  CLI::App* command = app.add_subcommand(name, summary);
  command->footer("Example:\n  " + example);
  command->fallthrough();
  return command;
}

void add_repeatable(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                    const std::string& description) {
  command.add_option(name, values, description + " (repeatable)")->allow_extra_args(false);
}

}  // namespace remomask::tools
