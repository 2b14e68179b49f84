#include <fmt/format.h>

#include "db/upgrade.h"
#include "tools/db_commands.h"

namespace remomask {

namespace {

void register_upgrade(CLI::App& group, Program& program) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = add_command(group, "upgrade", "bring a database to the present format",
                                  "remomask db upgrade motions.sqlite");
  command->add_option("database", *path, "database file")->required();
  command->callback([path, &program] {
    const UpgradeReport report = upgrade_database(*path);
    if (program.json) {
      return program.print_json({{"file", *path},
                                 {"version_before", report.version_before},
                                 {"version", report.version},
                                 {"bytes_before", report.bytes_before},
                                 {"bytes", report.bytes}});
    }
    fmt::print("{}: format {} (was {}), {:.1f} MB (was {:.1f})\n", *path, report.version,
               report.version_before, 1e-6 * static_cast<double>(report.bytes),
               1e-6 * static_cast<double>(report.bytes_before));
  });
}

}  // namespace

void register_db_upkeep(CLI::App& group, Program& program) { register_upgrade(group, program); }

}  // namespace remomask
