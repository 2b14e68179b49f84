#include "exchange/add_files.h"

#include <filesystem>

#include "db/transaction.h"
#include "exchange/motion_source.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"

namespace remomask::exchange {

namespace {

std::vector<PreparedClip> prepare_file(const std::string& path, const AddOptions& options,
                                       std::vector<std::string>& warnings) {
  MotionFileOptions reading;
  reading.skeleton_map = options.skeleton_map;
  reading.fps = options.fps;
  reading.root = options.root;
  db::Clip clip;
  clip.name = std::filesystem::path(path).stem().string();
  clip.source = options.source;
  clip.source_file = clip.name;
  clip.split = options.split;
  clip.licence = options.licence;
  clip.group = options.source + "/" + clip.name;
  clip.captions = options.captions;
  clip.labels = options.labels;
  clip.tags = options.tags;
  const LoadedMotion loaded = load_motion(path, reading);
  warnings.insert(warnings.end(), loaded.warnings.begin(), loaded.warnings.end());
  return cut_into_clips(clip, loaded.motion, humanml_skeleton(), options.windows);
}

}  // namespace

AddReport add_files(db::Database& database, const std::vector<std::string>& files,
                    const AddOptions& options) {
  AddReport report;
  for (const std::string& file : files) {
    std::vector<std::pair<int64_t, std::string>> stored;
    try {
      const auto clips = prepare_file(file, options, report.warnings);
      db::Transaction transaction(database);
      for (const PreparedClip& item : clips) {
        stored.emplace_back(database.add_clip(item.clip, item.motion), item.clip.name);
      }
      transaction.commit();
      report.clips.insert(report.clips.end(), stored.begin(), stored.end());
    } catch (const Error& error) {
      report.rejected.push_back({file, error.what()});
    }
  }
  return report;
}

}  // namespace remomask::exchange
