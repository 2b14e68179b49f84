#pragma once

#include <CLI/App.hpp>

#include "tools/program.h"

namespace remomask::tools {

// Sub-commands of `remomask db`; `group` is that command.
void register_db_list(CLI::App& group, Program& program);    // list, show
void register_db_change(CLI::App& group, Program& program);  // add, tag, remove, attribute
void register_db_describe(CLI::App& group, Program& program);
void register_db_exchange(CLI::App& group, Program& program);  // merge, export
void register_db_upkeep(CLI::App& group,
                        Program& program);  // info, check, snapshot, restore, upgrade

}  // namespace remomask::tools
