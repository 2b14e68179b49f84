#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/base/test_folder.h"

namespace remomask {

struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal when it was killed
  std::string output, errors;
  long peak_megabytes = 0;  ///< of its memory
};

/// Runs the program `remomask` with these arguments; `environment` adds to the
/// inherited one. Killed after `kill_after_seconds` with SIGKILL when positive.
ProgramResult run_program(const std::vector<std::string>& arguments,
                          const std::map<std::string, std::string>& environment = {},
                          double kill_after_seconds = 0, int signal_number = 9);

/// Runs with --json, expects success and parses the output. Throws
/// std::runtime_error that shows both outputs otherwise.
nlohmann::json run_json(std::vector<std::string> arguments);

}  // namespace remomask
