#include "tests/tools/program_runner.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

#include "base/file.h"

namespace remomask {

ProgramResult run_program(const std::vector<std::string>& arguments,
                          const std::map<std::string, std::string>& environment,
                          double kill_after_seconds, int signal_number) {
  const TestFolder scratch;
  const std::string out = scratch / "out", err = scratch / "err";
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    const int flags = O_WRONLY | O_CREAT | O_TRUNC;
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open(out.c_str(), flags, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), flags, 0600), STDERR_FILENO);
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    std::vector<char*> words = {const_cast<char*>(REMOMASK_PROGRAM)};
    for (const auto& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    execv(REMOMASK_PROGRAM, words.data());
    _exit(127);
  }
  int status = 0;
  if (kill_after_seconds > 0) {
    std::this_thread::sleep_for(std::chrono::duration<double>(kill_after_seconds));
    kill(child, signal_number);
  }
  rusage usage{};
  wait4(child, &status, 0, &usage);
  ProgramResult result;
  result.peak_megabytes = usage.ru_maxrss / 1024;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.output = read_file(out);
  result.errors = read_file(err);
  return result;
}

nlohmann::json run_json(std::vector<std::string> arguments) {
  arguments.push_back("--json");
  arguments.push_back("--quiet");
  const ProgramResult result = run_program(arguments);
  std::string command;
  for (const auto& word : arguments) command += " " + word;
  if (result.exit_code != 0) {
    throw std::runtime_error("remomask" + command + " failed with " +
                             std::to_string(result.exit_code) + ":\n" + result.errors);
  }
  return nlohmann::json::parse(result.output);
}

}  // namespace remomask
