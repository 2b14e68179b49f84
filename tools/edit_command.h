#pragma once

#include <string>
#include <vector>

#include "remomask/motion_file.h"
#include "tools/new_motion_options.h"
#include "tools/program.h"

namespace remomask::tools {

/// What `remomask edit` is asked for.
struct EditCommand : NewMotionOptions {
  EditCommand() { generation.generate.follow = EditOptions().follow; }

  std::string input, spans;
  std::vector<std::string> parts, cells;
  MotionFileOptions reading;  ///< of the input
  double extend = 0;          ///< seconds
  int fade = EditOptions().fade;
};

void run_edit(const EditCommand& command, Program& program);

}  // namespace remomask::tools
