#pragma once

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string>
#include <vector>

#include "remomask/progress.h"

namespace remomask::tools {

/// What every sub-command shares: global options, output, stopping. An interface, since the
/// commands that need the networks run in a shared object of their own (core.h).
class Program {
 public:
  virtual ~Program() = default;

  bool json = false;   ///< --json: one JSON document on standard output
  bool quiet = false;  ///< --quiet: no progress
  int threads = 0;     ///< --threads: 0 for all available CPUs

  /// Progress on standard error (a bar with an ETA on a terminal, plain lines
  /// otherwise) and a stop token that Ctrl-C requests.
  virtual Monitor monitor() = 0;

  /// Ends an open progress line.
  virtual void finish_progress() = 0;

  /// Prints the document with --json, otherwise does nothing.
  virtual void print_json(const nlohmann::json& document) = 0;

  /// A note for people on standard error.
  virtual void warn(const std::string& message) = 0;
};

/// The program on a terminal.
class TerminalProgram final : public Program {
 public:
  Monitor monitor() override;
  void finish_progress() override;
  void print_json(const nlohmann::json& document) override;
  void warn(const std::string& message) override;

  /// Whether the one document of --json is out.
  bool answered() const { return answered_; }

 private:
  bool answered_ = false;
};

/// Registers a sub-command: name, help with an example, options, what to run.
using RegisterCommand = void (*)(CLI::App& app, Program& program);

void register_ablate(CLI::App& app, Program& program);
void register_import(CLI::App& app, Program& program);
void register_import_text(CLI::App& app, Program& program);
void register_info(CLI::App& app, Program& program);
void register_index(CLI::App& app, Program& program);
void register_search(CLI::App& app, Program& program);
void register_train(CLI::App& app, Program& program);
void register_generate(CLI::App& app, Program& program);
void register_edit(CLI::App& app, Program& program);
void register_evaluate(CLI::App& app, Program& program);
void register_convert(CLI::App& app, Program& program);
void register_retarget(CLI::App& app, Program& program);
void register_sheet(CLI::App& app, Program& program);
void register_procedural(CLI::App& app, Program& program);
void register_skeleton(CLI::App& app, Program& program);
void register_check(CLI::App& app, Program& program);
void register_db(CLI::App& app, Program& program);

/// Adds a sub-command with its description and an example, shown by --help.
CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& summary,
                      const std::string& example);

/// An option that may be given several times, one value each time: it takes no
/// file or clip name that stands behind its value.
void add_repeatable(CLI::App& command, const std::string& name, std::vector<std::string>& values,
                    const std::string& description);

}  // namespace remomask::tools
