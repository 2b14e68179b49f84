#pragma once

#include <optional>
#include <string>

#include "remomask/motion_file.h"
#include "remomask/search.h"
#include "tools/program.h"
#include "tools/workspace.h"

namespace remomask::tools {

/// What `remomask search` is asked for.
struct SearchCommand {
  SearchQuery query;
  FileOptions files;
  FilterOptions filter;
  std::string like_file;
  MotionFileOptions reading;       ///< of like_file
  std::optional<double> from, to;  ///< seconds of the file
  std::string by = "all";          ///< name of a SearchBy
  bool ungrouped = false, captions = false;
};

void run_search(const SearchCommand& command, Program& program);

}  // namespace remomask::tools
