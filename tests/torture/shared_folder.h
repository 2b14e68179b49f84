#pragma once

#include <string>

#include "tests/tools/program_runner.h"
#include "tests/torture/scenarios.h"

namespace remomask {

/// What the commands on trial read, made once (Scenario says what is in it).
class SharedFolder {
 public:
  static SharedFolder& instance();
  std::string path() const { return scratch_ / "shared"; }
  /// Trains the model, if that was not done yet.
  void need_model();
  /// Runs a command and throws if it fails; "%" stands for this folder.
  void run(const Words& words);

 private:
  SharedFolder();
  TestFolder scratch_;
};

}  // namespace remomask
