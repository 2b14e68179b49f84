#pragma once

#include <optional>
#include <string>

#include "tools/program.h"
#include "tools/workspace.h"

namespace remomask::tools {

/// What `remomask index` is asked for.
struct IndexCommand {
  FileOptions files;
  std::optional<std::string> factory, search_parameters;  ///< unset: as the index file has them
  bool rebuild = false;
};

void run_index(const IndexCommand& command, Program& program);

}  // namespace remomask::tools
