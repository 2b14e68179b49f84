#pragma once

#include <cstdint>
#include <vector>

#include "tools/program.h"
#include "tools/workspace.h"

namespace remomask::tools {

/// What `remomask db describe` is asked for, when it is to guess.
struct DescribeCommand {
  FileOptions files;
  std::vector<int64_t> clips;  ///< without captions
  double min_probability = 0.3;
  int captions = 3;
};

void run_describe(const DescribeCommand& command, Program& program);

}  // namespace remomask::tools
