#pragma once

#include <string>

#include "tools/new_motion_options.h"
#include "tools/program.h"

namespace remomask::tools {

/// What `remomask generate` is asked for.
struct GenerateCommand : NewMotionOptions {
  std::string script;
  bool one_file = false;  ///< all motions as animations of one file
};

void run_generate(const GenerateCommand& command, Program& program);

}  // namespace remomask::tools
