#include <fmt/format.h>

#include "base/counted.h"
#include "db/check.h"
#include "db/snapshot.h"
#include "db/upgrade.h"
#include "remomask/error.h"
#include "tools/database_info.h"
#include "tools/db_commands.h"

namespace remomask::tools {

namespace {

void register_db_info(CLI::App& group, Program& program) {
  auto path = std::make_shared<std::string>();
  CLI::App* command =
      add_command(group, "info", "summarise a database", "remomask db info motions.sqlite");
  command->add_option("database", *path, "database file")->required();
  command->callback([path, &program] {
    const auto document = describe_database(*path);
    if (program.json) return program.print_json(document);
    print_description(document);
  });
}

void register_db_check(CLI::App& group, Program& program) {
  auto path = std::make_shared<std::string>();
  CLI::App* command =
      add_command(group, "check", "look for damage; the exit status is 1 when there is some",
                  "remomask db check motions.sqlite");
  command->add_option("database", *path, "database file")->required();
  command->callback([path, &program] {
    const db::CheckReport report = db::check_database(*path, program.monitor());
    program.finish_progress();
    nlohmann::json defects = nlohmann::json::array();
    for (const db::Defect& defect : report.defects) {
      defects.push_back(
          {{"clip_id", defect.clip_id}, {"clip", defect.clip}, {"what", defect.what}});
      if (program.json) continue;
      if (defect.clip_id == 0) {
        fmt::print("database: {}\n", defect.what);
      } else {
        fmt::print("clip {} (number {}): {}\n", defect.clip, defect.clip_id, defect.what);
      }
    }
    program.print_json({{"file", *path},
                        {"clips", report.clips},
                        {"captions", report.captions},
                        {"embeddings", report.embeddings},
                        {"defects", defects}});
    if (!report.defects.empty()) {
      throw Error(*path + ": " + counted(static_cast<int64_t>(report.defects.size()), "defect"));
    }
    if (!program.json) {
      fmt::print("{}: no defects ({}, {}, vectors of {})\n", *path, counted(report.clips, "clip"),
                 counted(report.captions, "caption"), counted(report.embeddings, "clip"));
    }
  });
}

void register_snapshot(CLI::App& group, Program& program) {
  struct Options {
    std::string database, target;
    bool force = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      add_command(group, "snapshot", "copy a database into one file, while others use it",
                  "remomask db snapshot motions.sqlite monday.sqlite");
  command->add_option("database", options->database, "database file")->required();
  command->add_option("target", options->target, "new file")->required();
  command->add_flag("--force", options->force, "replace the file if it exists");
  command->callback([options, &program] {
    db::snapshot_database(options->database, options->target, options->force, program.monitor());
    program.finish_progress();
    if (program.json) return program.print_json({{"snapshot", options->target}});
    fmt::print("{}: written\n", options->target);
  });
}

void register_restore(CLI::App& group, Program& program) {
  struct Options {
    std::string snapshot, database;
    bool force = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(group, "restore", "replace a database by a snapshot",
                                  "remomask db restore monday.sqlite motions.sqlite --force");
  command->add_option("snapshot", options->snapshot, "file that db snapshot wrote")->required();
  command->add_option("database", options->database, "database file")->required();
  command->add_flag("--force", options->force, "replace the database if it exists");
  command->callback([options, &program] {
    const db::RestoreReport report = db::restore_database(options->snapshot, options->database,
                                                          options->force, program.monitor());
    program.finish_progress();
    if (program.json) {
      return program.print_json({{"database", options->database}, {"set_aside", report.set_aside}});
    }
    if (!report.set_aside.empty()) {
      fmt::print("the damaged old file is now {}\n", report.set_aside);
    }
    fmt::print("{}: restored; rebuild its index: remomask index {}\n", options->database,
               options->database);
  });
}

void register_upgrade(CLI::App& group, Program& program) {
  auto path = std::make_shared<std::string>();
  auto accept_changes = std::make_shared<bool>(false);
  CLI::App* command = add_command(group, "upgrade", "upgrade a database to the current format",
                                  "remomask db upgrade motions.sqlite");
  command->add_option("database", *path, "database file")->required();
  command->add_flag("--accept-changes", *accept_changes,
                    "take pages as they are, after another program has written to the file");
  command->callback([path, accept_changes, &program] {
    const db::UpgradeReport report = db::upgrade_database(*path, *accept_changes);
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

void register_db_upkeep(CLI::App& group, Program& program) {
  register_db_info(group, program);
  register_db_check(group, program);
  register_snapshot(group, program);
  register_restore(group, program);
  register_upgrade(group, program);
}

}  // namespace remomask::tools
