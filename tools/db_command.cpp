#include "tools/db_commands.h"

namespace remomask::tools {

void register_db(CLI::App& app, Program& program) {
  CLI::App* group = add_command(app, "db", "look after a motion database: list, change, check ...",
                                "remomask db list motions.sqlite --words \"turns left\"");
  group->require_subcommand(1);
  register_db_list(*group, program);
  register_db_change(*group, program);
  register_db_describe(*group, program);
  register_db_exchange(*group, program);
  register_db_upkeep(*group, program);
}

}  // namespace remomask::tools
