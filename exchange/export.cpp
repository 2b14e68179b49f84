#include "exchange/export.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/file.h"
#include "remomask/error.h"

namespace remomask::exchange {

namespace {

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

}  // namespace

void export_clips(const db::Database& database, const std::vector<int64_t>& ids,
                  const std::string& folder, const ExportOptions& options, const Monitor& monitor) {
  namespace fs = std::filesystem;
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw FileError(folder, 0, "cannot be made: " + failed.message());
  if (!fs::is_empty(folder)) {
    throw FileError(folder, 0, "is not empty; name a new folder, so that nothing is mixed up");
  }
  const db::ReadSnapshot snapshot(database);
  FileNames names;
  std::string captions;
  for (size_t i = 0; i < ids.size(); ++i) {
    if (monitor.stop_requested()) {
      throw Interrupted("the export was stopped; delete " + folder + " before another");
    }
    const db::Clip clip = database.clip(ids[i]);
    const std::string stem = names.choose(clip.name);
    save_motion((fs::path(folder) / (stem + options.extension)).string(), database.motion(ids[i]),
                options.writing);
    captions += captions_line(clip, stem);
    monitor.report({"export " + database.path(), static_cast<double>(i + 1),
                    static_cast<double>(ids.size()), ""});
  }
  write_file_atomically((fs::path(folder) / "captions.jsonl").string(), captions);
}

}  // namespace remomask::exchange
