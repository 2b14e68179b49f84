#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/program.h"

namespace remomask::tools {

/// What `remomask import-text` is asked for.
struct ImportTextCommand {
  std::string folder, file, licence;
  std::optional<int64_t> max_tokens;
};

void run_import_text(const ImportTextCommand& command, Program& program);

}  // namespace remomask::tools
