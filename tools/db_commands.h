#pragma once

#include <CLI/App.hpp>

#include "tools/program.h"

namespace remomask {

// Sub-commands of `remomask db`; `group` is that command.
void register_db_upkeep(CLI::App& group, Program& program);

}  // namespace remomask
