#include <fmt/format.h>

#include "base/counted.h"
#include "base/machine.h"
#include "db/storing_database.h"
#include "exchange/import.h"
#include "remomask/error.h"
#include "tools/program.h"
#include "tools/reading_options.h"

namespace remomask::tools {

namespace {

nlohmann::json import_report_json(const exchange::ImportReport& report) {
  nlohmann::json rejected = nlohmann::json::array();
  for (const auto& entry : report.rejected) {
    rejected.push_back({{"file", entry.file}, {"reason", entry.reason}});
  }
  return {{"files", report.files},
          {"files_stored", report.files_stored},
          {"files_known", report.files_known},
          {"clips_stored", report.clips_stored},
          {"clips_windowed", report.clips_windowed},
          {"bytes_read", report.bytes_read},
          {"seconds", report.seconds},
          {"rejected", rejected},
          {"warnings", report.warnings}};
}

}  // namespace

void register_import(CLI::App& app, Program& program) {
  struct Options {
    exchange::ImportOptions import;
    std::string database;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(
      app, "import", "store a folder (or .tar.xz pack) of motion files with captions in a database",
      "remomask import bandai1.tar.xz --db motions.sqlite");
  command
      ->add_option(
          "folder", options->import.folder,
          "folder or archive of motion files (BVH, AMC, npy, npz), or a HumanML3D / KIT-ML "
          "folder")
      ->required();
  command->add_option("--db", options->database, "database file; created when missing")->required();
  command->add_option("--captions", options->import.captions_file,
                      "JSON Lines: {\"clip\", \"captions\", \"labels\", \"split\"}; default: "
                      "FOLDER.jsonl or FOLDER/captions.jsonl");
  command->add_option("--source", options->import.source, "name of the data set");
  command->add_option("--licence", options->import.licence, "licence of these motions");
  add_skeleton_map_option(*command, options->import.skeleton_map);
  add_reading_options(*command, options->import.fps, options->import.root);
  command->add_option("--min-frames", options->import.min_frames, "shorter clips are rejected")
      ->capture_default_str();
  command->add_option("--max-frames", options->import.max_frames, "longer clips become windows")
      ->capture_default_str();
  command->add_option("--overlap", options->import.window_overlap, "frames shared by windows")
      ->capture_default_str();
  command->callback([options, &program] {
    options->import.threads = program.threads > 0 ? program.threads : available_cpus();
    db::StoringDatabase storing(options->database);
    db::Database& database = *storing;
    const exchange::ImportReport report =
        exchange::import_folder(database, options->import, program.monitor());
    program.finish_progress();
    if (program.json) return program.print_json(import_report_json(report));
    for (const std::string& warning : report.warnings) program.warn(warning);
    for (const auto& entry : report.rejected) {
      fmt::print("rejected {}: {}\n", entry.file, entry.reason);
    }
    fmt::print("{} of {} stored now, {} stored before, {} rejected\n", report.files_stored,
               counted(report.files, "file"), report.files_known, report.rejected.size());
    fmt::print("{} ({} of long files), {:.1f} MB in {:.1f} s\n",
               counted(report.clips_stored, "clip"), counted(report.clips_windowed, "window"),
               static_cast<double>(report.bytes_read) / 1e6, report.seconds);
  });
}

}  // namespace remomask::tools
