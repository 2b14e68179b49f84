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
#include "tools/usage.h"

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

struct Failure {
  int code;
  std::string kind, message, path = "";
  long line = 0;
};

/// Says what failed: to people on standard error, with --json also as a document on standard
/// output.
int fail(Program& program, const Failure& failure) {
  program.finish_progress();
  fmt::print(stderr, "remomask: {}\n", failure.message);
  if (failure.code == kExitUsage) fmt::print(stderr, "--help shows what is there.\n");
  nlohmann::json error = {
      {"code", failure.code}, {"kind", failure.kind}, {"message", failure.message}};
  if (!failure.path.empty()) error["path"] = failure.path;
  if (failure.line > 0) error["line"] = failure.line;
  program.print_json({{"error", error}});
  return failure.code;
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
      ->check(non_negative_number());
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 ok, 1 failed, 2 wrong usage, 130 interrupted. \"remomask COMMAND --help\"\n"
      "shows the options of a command and an example.");
  const RegisterCommand commands[] = {
      register_generate, register_edit,     register_search,  register_import, register_index,
      register_train,    register_evaluate, register_convert, register_sheet,  register_procedural,
      register_info,     register_db,       register_ablate,
  };
  for (const RegisterCommand add : commands) add(app, program);
  try {
    app.parse(argc, argv);
    program.finish_progress();
    return std::fflush(stdout) == 0 && std::ferror(stdout) == 0
               ? 0
               : fail(program, {kExitFailed, "output", "cannot write to standard output"});
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForVersion& version) {
    return app.exit(version);
  } catch (const CLI::ParseError& error) {
    const std::string hint = usage_hint(app, argc, argv);
    return fail(program, {kExitUsage, "usage", hint.empty() ? error.what() : hint});
  } catch (const Interrupted& error) {
    return fail(program, {kExitInterrupted, "interrupted", error.what()});
  } catch (const FileError& error) {
    return fail(program, {kExitFailed, "file", error.what(), error.path(), error.line()});
  } catch (const std::bad_alloc&) {
    return fail(program,
                {kExitFailed, "memory", "out of memory; use smaller batches or fewer clips"});
  } catch (const std::exception& error) {
    return fail(program, {kExitFailed, "error", error.what()});
  }
}

}  // namespace
}  // namespace remomask::tools

int main(int argc, char** argv) { return remomask::tools::run(argc, argv); }
