#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <memory>

#include "base/counted.h"
#include "db/check.h"
#include "formats/motion_reading.h"
#include "formats/sidecar.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "tools/check_command.h"
#include "tools/core.h"

namespace remomask::tools {

namespace {

bool is_database(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string begin(15, '\0');
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin == "SQLite format 3";
}

CheckedFile check_database_file(const std::string& path, Program& program) {
  const db::CheckReport report = db::check_database(path, program.monitor());
  CheckedFile checked{.kind = "database", .has_checksums = report.has_checksums};
  checked.content =
      fmt::format("{}, {}, vectors of {}", counted(report.clips, "clip"),
                  counted(report.captions, "caption"), counted(report.embeddings, "clip"));
  for (const db::Defect& defect : report.defects) {
    checked.defects.push_back(
        defect.clip_id == 0
            ? defect.what
            : fmt::format("clip {} (number {}): {}", defect.clip, defect.clip_id, defect.what));
  }
  return checked;
}

CheckedFile check_motion_file(const std::string& path) {
  const LoadedMotion loaded = load_motion(path);
  // Throws if the file beside it speaks of another motion.
  formats::read_sidecar(path);
  return {.kind = "motion",
          .content = fmt::format("{}, {:.2f} s", counted(loaded.source_frames, "frame"),
                                 loaded.motion.seconds())};
}

CheckedFile check_file(const std::string& path, Program& program) {
  try {
    if (!std::filesystem::exists(path)) throw FileError(path, 0, "there is no such file");
    // Opening a pipe would wait for its writer.
    if (!std::filesystem::is_regular_file(path)) throw FileError(path, 0, "is not a regular file");
    if (is_database(path)) return check_database_file(path, program);
    if (formats::is_readable_motion(path)) return check_motion_file(path);
    return core(program).check_file(path);
  } catch (const Error& error) {
    return {.kind = "unknown", .defects = {error.what()}};
  }
}

nlohmann::json file_document(const std::string& path, const CheckedFile& checked) {
  return {{"file", path},
          {"kind", checked.kind},
          {"content", checked.content},
          {"checksums", checked.has_checksums},
          {"defects", checked.defects}};
}

void print_file(const std::string& path, const CheckedFile& checked) {
  for (const std::string& defect : checked.defects) {
    // Errors of files begin with their path already.
    fmt::print("{}{}\n", defect.starts_with(path) ? "" : path + ": ", defect);
  }
  if (!checked.defects.empty()) return;
  fmt::print("{}: {} in order ({}){}\n", path, checked.kind, checked.content,
             checked.has_checksums ? ""
                                   : "; it was written without checksums of all that it holds, so "
                                     "that some damage cannot be seen (a database: remomask db "
                                     "upgrade)");
}

}  // namespace

void register_check(CLI::App& app, Program& program) {
  auto paths = std::make_shared<std::vector<std::string>>();
  CLI::App* command =
      add_command(app, "check", "look for damage in files that remomask wrote",
                  "remomask check motions.sqlite motions.sqlite.index models/base.safetensors");
  command
      ->add_option("files", *paths, "databases, indexes, models, training checkpoints and motions")
      ->required();
  command->callback([paths, &program] {
    nlohmann::json files = nlohmann::json::array();
    int64_t damaged = 0;
    for (const std::string& path : *paths) {
      const CheckedFile checked = check_file(path, program);
      program.finish_progress();
      damaged += checked.defects.empty() ? 0 : 1;
      files.push_back(file_document(path, checked));
      if (!program.json) print_file(path, checked);
    }
    program.print_json({{"files", files}});
    if (damaged > 0) {
      throw Error(fmt::format("{} of {} damaged", damaged,
                              counted(static_cast<int64_t>(paths->size()), "file")));
    }
  });
}

}  // namespace remomask::tools
