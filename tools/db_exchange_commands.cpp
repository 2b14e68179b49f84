#include <fmt/format.h>

#include "base/counted.h"
#include "db/merge.h"
#include "exchange/export.h"
#include "formats/motion_writing.h"
#include "tools/clip_selection.h"
#include "tools/db_commands.h"
#include "tools/output_path.h"
#include "tools/write_options.h"

namespace remomask::tools {

namespace {

nlohmann::json pairs_json(const std::vector<std::pair<std::string, std::string>>& pairs,
                          const char* left, const char* right) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [first, second] : pairs) list.push_back({{left, first}, {right, second}});
  return list;
}

void register_merge(CLI::App& group, Program& program) {
  struct Options {
    std::string database, other;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(group, "merge", "add all clips of another database",
                                  "remomask db merge motions.sqlite colleague.sqlite");
  command->add_option("database", options->database, "database file that grows")->required();
  command->add_option("other", options->other, "database file that is read")->required();
  command->callback([options, &program] {
    db::Database database(options->database, db::OpenMode::read_write);
    const db::Database other(options->other, db::OpenMode::read_only);
    const db::MergeReport report = db::merge_database(database, other, program.monitor());
    program.finish_progress();
    if (program.json) {
      return program.print_json({{"clips", report.clips},
                                 {"added", report.added},
                                 {"embeddings", report.embeddings},
                                 {"duplicates", pairs_json(report.duplicates, "clip", "same_as")},
                                 {"renamed", pairs_json(report.renamed, "clip", "name")},
                                 {"warnings", report.warnings}});
    }
    for (const std::string& warning : report.warnings) program.warn(warning);
    for (const auto& [clip, same] : report.duplicates) {
      fmt::print("left out {}: it is the same motion as {}\n", clip, same);
    }
    for (const auto& [clip, name] : report.renamed) fmt::print("{} is now {}\n", clip, name);
    fmt::print("{} of {} added ({}, {} renamed), with the vectors of {}\n", report.added,
               counted(report.clips, "clip"),
               counted(static_cast<int64_t>(report.duplicates.size()), "duplicate"),
               report.renamed.size(), counted(report.embeddings, "clip"));
  });
}

struct ExportCommand {
  std::string database, folder;
  std::string format = "npy";
  WriteOptions writing;
  ClipSelection selection;
  OutputOptions overwrite;
  bool resume = false, one_file = false;
};

void export_one_file(const ExportCommand& command, Program& program) {
  const MotionWriteOptions writing = command.writing.chosen(command.folder);
  require_writable_output(command.folder);
  const db::Database database(command.database, db::OpenMode::read_only);
  const auto ids = command.selection.ids(database);
  command.overwrite.check(command.folder, command.database, program);
  exchange::export_together(database, ids, command.folder, writing, program.monitor());
  program.finish_progress();
  if (program.json) {
    return program.print_json({{"output", command.folder}, {"clips", ids.size()}});
  }
  fmt::print("{}: {}\n", command.folder, counted(static_cast<int64_t>(ids.size()), "clip"));
}

void register_export(CLI::App& group, Program& program) {
  auto options = std::make_shared<ExportCommand>();
  CLI::App* command =
      add_command(group, "export", "write clips as files that remomask import reads back",
                  "remomask db export motions.sqlite my_clips --tag good --format bvh\n"
                  "  remomask db export motions.sqlite good.glb --one-file --tag good");
  command->add_option("database", options->database, "database file")->required();
  command->add_option("folder", options->folder, "new or empty folder; with --one-file: a file")
      ->required();
  options->selection.add(*command);
  std::vector<std::string> known;
  for (const formats::MotionFormat& format : formats::written_formats()) {
    known.emplace_back(format.extension.substr(1));
  }
  CLI::Option* format =
      command
          ->add_option("--format", options->format,
                       "npy (default) keeps the exact positions, the others open in other programs")
          ->check(CLI::IsMember(known));
  options->writing.add(*command);
  options->writing.add_own_proportions(*command);
  CLI::Option* resume =
      command->add_flag("--resume", options->resume, "go on with an export that was stopped");
  command
      ->add_flag("--one-file", options->one_file,
                 "all clips as the animations of one .glb or .fbx file")
      ->excludes(format)
      ->excludes(resume);
  options->overwrite.add(*command);
  command->callback([options, &program] {
    if (options->one_file) return export_one_file(*options, program);
    exchange::ExportOptions writing;
    writing.resume = options->resume;
    writing.extension = "." + options->format;
    writing.writing = options->writing.chosen("clip" + writing.extension);
    const db::Database database(options->database, db::OpenMode::read_only);
    const auto ids = options->selection.ids(database);
    exchange::export_clips(database, ids, options->folder, writing, program.monitor());
    program.finish_progress();
    if (program.json) {
      return program.print_json({{"folder", options->folder}, {"clips", ids.size()}});
    }
    fmt::print("{}: {}\n", options->folder, counted(static_cast<int64_t>(ids.size()), "clip"));
  });
}

}  // namespace

void register_db_exchange(CLI::App& group, Program& program) {
  register_merge(group, program);
  register_export(group, program);
}

}  // namespace remomask::tools
