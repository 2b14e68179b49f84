#include "exchange/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/file.h"
#include "base/hash.h"
#include "base/json.h"
#include "base/leftovers.h"
#include "formats/animation_formats.h"
#include "remomask/error.h"

namespace remomask::exchange {

namespace {

namespace fs = std::filesystem;

constexpr const char* kPlanFile = "export.json";
constexpr size_t kMaxClipsOfOneFile = 1000;

/// A file name for every clip: its name without signs that mean something to a
/// file system, with a number where two become the same.
class FileNames {
 public:
  std::string choose(const std::string& clip_name) {
    std::string stem = clip_name;
    for (char& c : stem) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < 32 || std::string("/\\:*?\"<>|").find(c) != std::string::npos) c = '_';
    }
    if (stem.front() == '.') stem.front() = '_';
    // Two names that differ in case alone are one file on some systems.
    for (int number = 2; !used_.insert(lower(stem)).second; ++number) {
      if (number > 2) stem.erase(stem.rfind('~'));
      stem += "~" + std::to_string(number);
    }
    return stem;
  }

 private:
  static std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    return text;
  }
  std::set<std::string> used_;
};

std::string captions_line(const db::Clip& clip, const std::string& stem) {
  nlohmann::ordered_json line;
  line["clip"] = stem;
  line["name"] = clip.name;
  line["captions"] = clip.captions;
  line["labels"] = clip.labels;
  line["split"] = clip.split;
  line["licence"] = clip.licence;
  line["group"] = clip.group;
  line["tags"] = clip.tags;
  line["canonical"] = true;
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

/// What an export writes, as long as it is not finished. Two of the same text write the same files.
nlohmann::json export_plan(const db::Database& database, const std::vector<int64_t>& ids,
                           const ExportOptions& options) {
  std::string chosen;
  for (const int64_t id : ids) chosen += std::to_string(id) + ",";
  const MotionWriteOptions& writing = options.writing;
  return {{"database", database.uuid()},
          {"generation", database.generation()},
          {"clips", content_hash(chosen)},
          {"extension", options.extension},
          {"names", static_cast<int>(writing.names.value_or(JointNames::mixamo))},
          {"fps", writing.fps.value_or(0)},
          {"units", writing.units ? static_cast<int>(*writing.units) : -1},
          {"in_place", writing.in_place},
          {"loop", writing.loop},
          {"own_proportions", writing.own_proportions},
          {"common_skeleton", writing.common_skeleton},
          {"npz", static_cast<int>(writing.npz)},
          {"features", writing.features},
          {"character", writing.character},
          {"character_map", writing.character_map},
          {"root_motion", writing.root_motion}};
}

/// Makes the folder, or finds the same export in it, unfinished. Throws FileError for any other
/// content.
void begin_export(const std::string& folder, const nlohmann::json& plan, bool resume) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw FileError(folder, 0, "cannot be made: " + failed.message());
  // An export that was killed at its very beginning leaves no more than that.
  remove_leftovers(folder, kTemporaryMarker);
  const std::string plan_path = (fs::path(folder) / kPlanFile).string();
  if (fs::exists(plan_path)) {
    if (!resume) {
      throw FileError(folder, 0,
                      "holds an export that was not finished; go on with --resume, or name another "
                      "folder");
    }
    if (try_parse_json(read_file(plan_path)) != plan) {
      throw FileError(plan_path, 0,
                      "the export that was begun here is another one (other clips or options, or "
                      "the database has changed); name another folder");
    }
    return;
  }
  if (!fs::is_empty(folder)) {
    throw FileError(folder, 0, "is not empty; name a new folder, so that nothing is mixed up");
  }
  write_file_atomically(plan_path, plan.dump(1) + "\n");
}

/// Whether the folder holds the whole export already: the captions come last but for the plan.
bool is_finished(const std::string& folder, const std::string& captions_path,
                 const std::string& captions) {
  return !fs::exists(fs::path(folder) / kPlanFile) && fs::exists(captions_path) &&
         read_file(captions_path) == captions;
}

}  // namespace

void export_clips(const db::Database& database, const std::vector<int64_t>& ids,
                  const std::string& folder, const ExportOptions& options, const Monitor& monitor) {
  const db::ReadSnapshot snapshot(database);
  FileNames names;
  std::vector<std::string> files;
  std::string captions;
  for (const int64_t id : ids) {
    const db::Clip clip = database.clip(id);
    const std::string stem = names.choose(clip.name);
    files.push_back((fs::path(folder) / (stem + options.extension)).string());
    captions += captions_line(clip, stem);
  }
  const std::string captions_path = (fs::path(folder) / "captions.jsonl").string();
  if (options.resume && is_finished(folder, captions_path, captions)) return;
  begin_export(folder, export_plan(database, ids, options), options.resume);
  for (size_t i = 0; i < ids.size(); ++i) {
    if (monitor.stop_requested()) {
      throw Interrupted("the export was stopped; the same command with --resume goes on");
    }
    // Files are written whole or not at all.
    if (!fs::exists(files[i])) save_motion(files[i], database.motion(ids[i]), options.writing);
    monitor.report({"export " + database.path(), static_cast<double>(i + 1),
                    static_cast<double>(ids.size()), ""});
  }
  write_file_atomically(captions_path, captions);
  fs::remove(fs::path(folder) / kPlanFile);
}

void export_together(const db::Database& database, const std::vector<int64_t>& ids,
                     const std::string& path, const MotionWriteOptions& writing,
                     const Monitor& monitor) {
  formats::require_room_for_several(path);
  if (!writing.character.empty()) {
    throw Error(
        "several motions cannot be put onto a character in one file; leave out one of them");
  }
  if (ids.size() > kMaxClipsOfOneFile) {
    throw Error(
        fmt::format("{} clips are too many for one file, which holds up to {}; choose "
                    "fewer, or export a folder",
                    ids.size(), kMaxClipsOfOneFile));
  }
  const db::ReadSnapshot snapshot(database);
  std::vector<Motion> motions;
  std::vector<nlohmann::json> about;
  std::vector<std::string> names;
  for (const int64_t id : ids) {
    if (monitor.stop_requested()) throw Interrupted("the export was stopped; nothing was written");
    const db::Clip clip = database.clip(id);
    motions.push_back(database.motion(id));
    names.push_back(clip.name);
    about.push_back({{"clip", clip.name},
                     {"captions", clip.captions},
                     {"licence", clip.licence},
                     {"source", clip.source}});
    monitor.report({"export " + database.path(), static_cast<double>(motions.size()),
                    static_cast<double>(ids.size()), ""});
  }
  std::vector<formats::WritingJob> jobs;
  for (size_t i = 0; i < motions.size(); ++i) {
    jobs.push_back({motions[i], writing, &about[i], names[i]});
  }
  formats::write_together(path, jobs);
}

}  // namespace remomask::exchange
