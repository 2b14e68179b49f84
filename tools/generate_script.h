#pragma once

#include <cstdint>
#include <string>

#include "db/database.h"
#include "tools/generation_options.h"
#include "tools/program.h"

namespace remomask::tools {

/// The command generate with --script: reads the script, makes one motion of all
/// its sentences, stores it with the evidence and figures of every segment, and
/// reports them. `sheet` may be empty.
void run_script(const GenerationWorkspace& workspace, const std::string& script_path,
                const std::string& output, const std::string& sheet, uint64_t seed,
                const search::ClipFilter& evidence, Program& program);

}  // namespace remomask::tools
