#include <faiss/Index.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <torch/version.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>

#include "remomask/error.h"
#include "remomask/version.h"
#include "tools/help_formatter.h"
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
int fail(TerminalProgram& program, const Failure& failure) {
  program.finish_progress();
  fmt::print(stderr, "remomask: {}\n", failure.message);
  if (failure.code == kExitUsage) fmt::print(stderr, "--help shows what is there.\n");
  // A command that answers and then fails, as db check does, has said what it found; into an
  // output that takes nothing, nothing can be said.
  if (program.answered() || std::ferror(stdout) != 0) return failure.code;
  nlohmann::json error = {
      {"code", failure.code}, {"kind", failure.kind}, {"message", failure.message}};
  if (!failure.path.empty()) error["path"] = failure.path;
  if (failure.line > 0) error["line"] = failure.line;
  program.print_json({{"error", error}});
  return failure.code;
}

/// Ends with `status` if all output could be written.
int finish(TerminalProgram& program, int status) {
  program.finish_progress();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  return fail(program, {kExitFailed, "output", "cannot write to standard output"});
}

Failure out_of_memory() {
  return {kExitFailed, "memory",
          "out of memory; use smaller batches, fewer clips or fewer threads"};
}

/// Of a library's exception: what follows the first line are its own frames.
Failure foreign_failure(const std::string& text) {
  if (text.find("can't allocate memory") != std::string::npos ||
      text.find("not enough memory") != std::string::npos) {
    return out_of_memory();
  }
  return {kExitFailed, "error", text.substr(0, text.find('\n'))};
}

int run(int argc, char** argv) {
  TerminalProgram program;
  CLI::App app{
      "remomask: text to human motion. Searches a database of motions by meaning and uses what\n"
      "it finds to generate a new one."};
  app.name("remomask");
  app.formatter(std::make_shared<HelpFormatter>());  // Before the commands, which inherit it.
  app.set_version_flag("--version", version_text());
  app.add_flag("--json", program.json, "print one JSON document on standard output");
  app.add_flag("--quiet", program.quiet, "no progress");
  app.add_option("--threads", program.threads, "CPU threads; 0: all available")->check(at_least(0));
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 ok, 1 failed, 2 wrong usage, 130 interrupted. \"remomask COMMAND --help\"\n"
      "shows the options of a command and an example.");
  const RegisterCommand commands[] = {
      register_generate,    register_edit,     register_search,   register_import,
      register_import_text, register_index,    register_train,    register_evaluate,
      register_convert,     register_retarget, register_skeleton, register_sheet,
      register_procedural,  register_info,     register_check,    register_db,
      register_ablate,
  };
  for (const RegisterCommand add : commands) add(app, program);
  try {
    app.parse(argc, argv);
    return finish(program, 0);
  } catch (const CLI::CallForHelp& help) {
    return finish(program, app.exit(help));
  } catch (const CLI::CallForVersion& version) {
    return finish(program, app.exit(version));
  } catch (const CLI::ParseError& error) {
    const std::string hint =
        usage_hint(app, argc, argv, dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr);
    return fail(program, {kExitUsage, "usage", hint.empty() ? error.what() : hint});
  } catch (const Interrupted& error) {
    return fail(program, {kExitInterrupted, "interrupted", error.what()});
  } catch (const FileError& error) {
    return fail(program, {kExitFailed, "file", error.what(), error.path(), error.line()});
  } catch (const std::bad_alloc&) {
    return fail(program, out_of_memory());
  } catch (const Error& error) {
    return fail(program, {kExitFailed, "error", error.what()});
  } catch (const std::exception& error) {
    return fail(program, foreign_failure(error.what()));
  }
}

}  // namespace
}  // namespace remomask::tools

int main(int argc, char** argv) {
  // A file that would grow beyond `ulimit -f` then fails to be written, with a message.
  std::signal(SIGXFSZ, SIG_IGN);
  return remomask::tools::run(argc, argv);
}
