#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/machine.h"
#include "db/storing_database.h"
#include "exchange/archive.h"
#include "exchange/import.h"
#include "remomask/error.h"
#include "tools/program.h"
#include "tools/reading_options.h"

namespace remomask::tools {

namespace {

using Reports = std::vector<std::pair<std::string, exchange::ImportReport>>;

/// Of all folders together; each list says which one it is about.
nlohmann::json import_report_json(const Reports& reports) {
  exchange::ImportReport all;
  nlohmann::json rejected = nlohmann::json::array();
  for (const auto& [folder, report] : reports) {
    all.files += report.files;
    all.files_stored += report.files_stored;
    all.files_known += report.files_known;
    all.clips_stored += report.clips_stored;
    all.clips_windowed += report.clips_windowed;
    all.bytes_read += report.bytes_read;
    all.seconds += report.seconds;
    for (const auto& entry : report.rejected) {
      rejected.push_back({{"folder", folder}, {"file", entry.file}, {"reason", entry.reason}});
    }
    all.warnings.insert(all.warnings.end(), report.warnings.begin(), report.warnings.end());
  }
  return {{"files", all.files},
          {"files_stored", all.files_stored},
          {"files_known", all.files_known},
          {"clips_stored", all.clips_stored},
          {"clips_windowed", all.clips_windowed},
          {"bytes_read", all.bytes_read},
          {"seconds", all.seconds},
          {"rejected", rejected},
          {"warnings", all.warnings}};
}

void print_report(const exchange::ImportReport& report, Program& program) {
  for (const std::string& warning : report.warnings) program.warn(warning);
  for (const auto& entry : report.rejected) {
    fmt::print("rejected {}: {}\n", entry.file, entry.reason);
  }
  fmt::print("{} of {} stored now, {} stored before, {} rejected\n", report.files_stored,
             counted(report.files, "file"), report.files_known, report.rejected.size());
  fmt::print("{} ({} of long files), {:.1f} MB in {:.1f} s\n", counted(report.clips_stored, "clip"),
             counted(report.clips_windowed, "window"), static_cast<double>(report.bytes_read) / 1e6,
             report.seconds);
}

std::string data_set_name(const std::string& folder) {
  if (exchange::is_archive_name(folder)) return exchange::archive_stem(folder);
  return std::filesystem::canonical(folder).filename().string();
}

/// Nothing is stored when the command is wrong for one of the folders.
void check_folders(const std::vector<std::string>& folders,
                   const exchange::ImportOptions& options) {
  std::set<std::string> names;
  for (const std::string& folder : folders) {
    if (!std::filesystem::exists(folder)) {
      throw Error(folder + ": there is no such folder or archive; check the path");
    }
    // Files of a data set that has the name already would replace its files.
    if (const std::string name = data_set_name(folder); !names.insert(name).second) {
      throw Error(folder + ": a data set '" + name +
                  "' is named before it; import this one by itself, with another --source");
    }
  }
  if (folders.size() == 1 || (options.captions_file.empty() && options.source.empty())) return;
  throw Error(std::string(options.source.empty() ? "--captions" : "--source") +
              " is about one folder; import this one by itself");
}

}  // namespace

void register_import(CLI::App& app, Program& program) {
  struct Options {
    std::vector<std::string> folders;
    exchange::ImportOptions import;
    std::string database;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = add_command(
      app, "import", "store folders (or .tar.xz packs) of motion files with captions in a database",
      "remomask import bandai1.tar.xz cmu2.tar.xz --db motions.sqlite");
  command
      ->add_option(
          "folders", options->folders,
          "folders or archives of motion files (BVH, AMC, npy, npz), or HumanML3D / KIT-ML "
          "folders")
      ->required();
  command->add_option("--db", options->database, "database file; created when missing")->required();
  command->add_option("--captions", options->import.captions_file,
                      "JSON Lines: {\"clip\", \"captions\", \"labels\", \"split\"}; default: "
                      "FOLDER.jsonl or FOLDER/captions.jsonl");
  command->add_option("--source", options->import.source, "name of the data set");
  command->add_option("--licence", options->import.licence, "licence of these motions");
  add_reading_options(*command, options->import);
  command->add_option("--min-frames", options->import.min_frames, "shorter clips are rejected")
      ->capture_default_str();
  command->add_option("--max-frames", options->import.max_frames, "longer clips become windows")
      ->capture_default_str();
  command->add_option("--overlap", options->import.window_overlap, "frames shared by windows")
      ->capture_default_str();
  command->callback([options, &program] {
    options->import.threads = program.threads > 0 ? program.threads : available_cpus();
    check_folders(options->folders, options->import);
    db::StoringDatabase storing(options->database);
    Reports reports;
    for (const std::string& folder : options->folders) {
      options->import.folder = folder;
      reports.emplace_back(folder,
                           exchange::import_folder(*storing, options->import, program.monitor()));
      program.finish_progress();
      if (program.json) continue;
      if (options->folders.size() > 1) fmt::print("{}:\n", folder);
      print_report(reports.back().second, program);
    }
    program.print_json(import_report_json(reports));
  });
}

}  // namespace remomask::tools
