#include "tools/db_commands.h"

namespace remomask {

void register_db(CLI::App& app, Program& program) {
  CLI::App* group = add_command(app, "db", "look after a motion database: list, change, check ...",
                                "remomask db upgrade motions.sqlite");
  group->require_subcommand(1);
  register_db_upkeep(*group, program);
}

}  // namespace remomask
