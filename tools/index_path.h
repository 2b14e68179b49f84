#pragma once

#include <string>

#include "index/vector_index.h"
#include "tools/workspace.h"

namespace remomask::tools {

/// --index, or beside the database.
inline std::string index_path(const FileOptions& files) {
  return files.index.empty() ? index::default_index_path(files.database_path()) : files.index;
}

}  // namespace remomask::tools
