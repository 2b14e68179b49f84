#pragma once

#include <string>

#include "tools/generation_options.h"
#include "tools/output_path.h"
#include "tools/program.h"
#include "tools/workspace.h"
#include "tools/write_options.h"

namespace remomask::tools {

/// What `remomask generate` is asked for.
struct GenerateCommand {
  std::string prompt, script, output, sheet;
  FileOptions files;
  FilterOptions filter;
  GenerationOptions generation;
  OutputOptions overwrite;
  WriteOptions writing;
  int count = 1;
  bool one_file = false;  ///< all motions as animations of one file
};

void run_generate(const GenerateCommand& command, Program& program);

}  // namespace remomask::tools
