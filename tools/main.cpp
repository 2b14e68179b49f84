#include <faiss/Index.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <torch/version.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>

#include "remomask/error.h"
#include "remomask/version.h"
#include "tools/program.h"

namespace remomask::tools {
namespace {

constexpr int kExitFailed = 1;
constexpr int kExitUsage = 2;
constexpr int kExitInterrupted = 130;  // as a shell reports SIGINT

/// The version and what this program was built with; nothing is loaded for it.
std::string version_text() {
  return fmt::format(
      "remomask {}\ncompiler {}, C++ {}\nlibtorch {}.{}.{}, FAISS {}.{}.{}, SQLite {}",
      REMOMASK_VERSION, __VERSION__, __cplusplus, TORCH_VERSION_MAJOR, TORCH_VERSION_MINOR,
      TORCH_VERSION_PATCH, FAISS_VERSION_MAJOR, FAISS_VERSION_MINOR, FAISS_VERSION_PATCH,
      SQLITE_VERSION);
}

int run(int argc, char** argv) {
  TerminalProgram program;
  CLI::App app{
      "remomask: text to human motion. Searches a database of motions by meaning and uses what\n"
      "it finds to generate a new one."};
  app.name("remomask");
  app.set_version_flag("--version", version_text());
  app.add_flag("--json", program.json, "print one JSON document on standard output");
  app.add_flag("--quiet", program.quiet, "no progress");
  app.add_option("--threads", program.threads, "CPU threads; 0: all available")
      ->check(CLI::NonNegativeNumber);
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 ok, 1 failed, 2 wrong usage. \"remomask COMMAND --help\" shows the\n"
      "options of a command and an example.");
  const RegisterCommand commands[] = {
      register_generate, register_edit,     register_search,  register_import, register_index,
      register_train,    register_evaluate, register_convert, register_sheet,  register_procedural,
      register_info,     register_db,       register_ablate,
  };
  for (const RegisterCommand add : commands) add(app, program);
  try {
    app.parse(argc, argv);
    program.finish_progress();
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  } catch (const Interrupted& error) {
    program.finish_progress();
    fmt::print(stderr, "remomask: {}\n", error.what());
    return kExitInterrupted;
  } catch (const std::bad_alloc&) {
    program.finish_progress();
    fmt::print(stderr, "remomask: out of memory; use smaller batches or fewer clips\n");
    return kExitFailed;
  } catch (const std::exception& error) {
    program.finish_progress();
    fmt::print(stderr, "remomask: {}\n", error.what());
    return kExitFailed;
  }
}

}  // namespace
}  // namespace remomask::tools

int main(int argc, char** argv) { return remomask::tools::run(argc, argv); }
