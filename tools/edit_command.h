#pragma once

#include <string>
#include <vector>

#include "remomask/motion_file.h"
#include "tools/generation_options.h"
#include "tools/output_path.h"
#include "tools/program.h"
#include "tools/workspace.h"
#include "tools/write_options.h"

namespace remomask::tools {

/// What `remomask edit` is asked for.
struct EditCommand {
  EditCommand() { generation.generate.follow = EditOptions().follow; }

  std::string input, output, prompt, spans, sheet;
  std::vector<std::string> parts, cells;
  MotionFileOptions reading;  ///< of the input
  double extend = 0;          ///< seconds
  int fade = EditOptions().fade;
  FileOptions files;
  FilterOptions filter;
  GenerationOptions generation;
  OutputOptions overwrite;
  WriteOptions writing;
  int count = 1;
};

void run_edit(const EditCommand& command, Program& program);

}  // namespace remomask::tools
