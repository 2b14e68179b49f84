#pragma once

#include <string>

#include "tools/generation_options.h"
#include "tools/output_path.h"
#include "tools/program.h"
#include "tools/workspace.h"
#include "tools/write_options.h"

namespace remomask::tools {

/// What `generate` and `edit` share: where a motion comes from and where it goes.
struct NewMotionOptions {
  std::string prompt, output, sheet;
  FileOptions files;
  FilterOptions filter;
  GenerationOptions generation;
  OutputOptions overwrite;
  WriteOptions writing;
  int count = 1;

  void add_output(CLI::App& command);
  /// --seed and --count.
  void add_count(CLI::App& command);
  /// Of the model, the search, the generation, and the written file.
  void add_rest(CLI::App& command);
};

}  // namespace remomask::tools
