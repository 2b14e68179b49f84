#include "exchange/motion_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <unordered_map>

#include "base/bounded_file.h"
#include "base/hash.h"
#include "formats/acclaim.h"
#include "formats/motion_reading.h"
#include "formats/npy.h"
#include "remomask/error.h"
#include "remomask/motion_file.h"
#include "rig/skeleton_map.h"

namespace remomask::exchange {

namespace {

namespace fs = std::filesystem;

/// Rates of a file and of its labels that differ by less are the same, rounded.
constexpr double kRateTolerance = 0.01;
constexpr uint64_t kMaxMotionBytes = uint64_t{1} << 30;

std::string path_without_extension(const std::string& name) {
  return fs::path(name).replace_extension().generic_string();
}

/// Labels of a captions file that say how its motion file must be read.
class ReadingLabels {
 public:
  ReadingLabels(const std::string& captions_path, const CaptionEntry& entry)
      : path_(captions_path), entry_(entry) {}

  MotionFileOptions options() const {
    MotionFileOptions options;
    if (const auto* value = label("skip_frames")) {
      if (!value->is_number_integer() || value->get<int64_t>() < 0) fail("skip_frames", "a count");
      options.skip_frames = value->get<int>();
    }
    if (const auto* value = label("metres_per_unit")) {
      if (!value->is_number() || !(value->get<double>() > 0)) {
        fail("metres_per_unit", "a positive number");
      }
      options.metres_per_unit = value->get<double>();
    }
    const std::string up_axis = text("up_axis");
    if (!up_axis.empty()) {
      if (up_axis != "X" && up_axis != "Y" && up_axis != "Z") fail("up_axis", "X, Y or Z");
      options.up_axis = up_axis[0];
    }
    options.skeleton_map = text("skeleton");
    return options;
  }

  /// Frames a second, where the labels say so.
  std::optional<double> fps() const {
    const auto* value = label("fps");
    if (!value || !value->is_number() || !(value->get<double>() > 0)) return std::nullopt;
    return value->get<double>();
  }

  std::string text(const char* key) const {
    const auto* value = label(key);
    if (!value) return "";
    if (!value->is_string()) fail(key, "a text");
    return value->get<std::string>();
  }

 private:
  const nlohmann::json* label(const char* key) const {
    const auto value = entry_.labels.find(key);
    return value == entry_.labels.end() ? nullptr : &*value;
  }
  [[noreturn]] void fail(const std::string& key, const std::string& wanted) const {
    throw FileError(path_, entry_.line, "label '" + key + "' must be " + wanted);
  }

  const std::string& path_;
  const CaptionEntry& entry_;
};

bool is_shipped_map(const std::string& name) {
  const auto& maps = rig::shipped_skeleton_maps();
  return std::any_of(maps.begin(), maps.end(),
                     [&](const rig::SkeletonMap& map) { return map.name == name; });
}

/// The name of a map in the labels is a hint: a map that we do not have, or that
/// does not fit, is no reason to refuse a skeleton that we know by its joints.
/// (Nor is it ever taken for the path of a file, as a map of the user is.)
LoadedMotion load_with_hint(const SourceFile& file, MotionFileOptions options,
                            std::vector<std::string>& warnings) {
  const std::string hint = options.skeleton_map;
  if (hint.empty()) return load_motion(file.path, options);
  std::string reason = "there is no such map";
  if (is_shipped_map(hint)) {
    try {
      return load_motion(file.path, options);
    } catch (const Error& error) {
      reason = error.what();
    }
  }
  options.skeleton_map.clear();
  LoadedMotion loaded = load_motion(file.path, options);
  warnings.push_back(file.name + ": skeleton '" + hint + "' of its labels was not used (" + reason +
                     "); read as '" + loaded.skeleton_map + "' by its joint names");
  return loaded;
}

/// Reads a file by the options and labels that say how. A rate in the labels corrects one that the
/// file states wrongly or not at all; .npy files never state one, and labels may describe what they
/// were made from.
class DescribedFile {
 public:
  DescribedFile(const SourceFile& file, const MotionFileOptions& options, bool map_is_hint)
      : file_(file), options_(options), map_is_hint_(map_is_hint) {}

  Motion load(std::optional<double> labelled_fps, std::vector<std::string>& warnings) {
    if (options_.fps || !labelled_fps || fs::path(file_.path).extension() == ".npy") {
      return keep(load_once(options_), warnings);
    }
    MotionFileOptions by_label = options_;
    by_label.fps = labelled_fps;
    LoadedMotion loaded;
    try {
      loaded = load_once(options_);
    } catch (const Error&) {
      return keep(load_once(by_label), warnings);  // corrects an impossible rate
    }
    if (std::abs(loaded.source_fps / *labelled_fps - 1) < kRateTolerance) {
      return keep(std::move(loaded), warnings);
    }
    warnings.push_back(
        fmt::format("{}: is read at the {:g} frames a second of its labels; the file says {:g}",
                    file_.name, *labelled_fps, loaded.source_fps));
    return keep(load_once(by_label), warnings);
  }

 private:
  LoadedMotion load_once(const MotionFileOptions& options) {
    if (!map_is_hint_) return load_motion(file_.path, options);
    std::vector<std::string> notes;
    LoadedMotion loaded = load_with_hint(file_, options, notes);
    loaded.warnings.insert(loaded.warnings.end(), notes.begin(), notes.end());
    return loaded;
  }

  static Motion keep(LoadedMotion loaded, std::vector<std::string>& warnings) {
    warnings.insert(warnings.end(), loaded.warnings.begin(), loaded.warnings.end());
    return std::move(loaded.motion);
  }

  const SourceFile& file_;
  const MotionFileOptions options_;
  const bool map_is_hint_;
};

/// What an export wrote: canonical already, exactly so in npy.
Motion load_stored_motion(const std::string& path) {
  MotionFileOptions options;
  options.up_axis = 'Y';
  if (fs::path(path).extension() != ".npy") return load_motion(path, options).motion;
  formats::NpyArray array = formats::read_npy(path);
  const auto joints = static_cast<size_t>(humanml_skeleton().joints());
  if (array.shape.size() != 3 || array.shape[1] != joints || array.shape[2] != 3) {
    throw FileError(path, 0, "is not frames x 22 x 3 positions, though it is called canonical");
  }
  Motion motion(static_cast<int>(array.shape[0]), humanml_skeleton().joints());
  motion.positions = std::move(array.values);
  return motion;
}

}  // namespace

MotionFolder::MotionFolder(const ImportOptions& options) : MotionSource(options) {
  if (!options_.captions_file.empty()) captions_ = CaptionsFile(options_.captions_file);
  find_files();
  name_clips();
  match_captions();
}

void MotionFolder::find_files() {
  for (const auto& entry : fs::recursive_directory_iterator(options_.folder)) {
    if (!entry.is_regular_file() || !formats::is_readable_motion(entry.path().string())) continue;
    files_.push_back({entry.path().lexically_relative(options_.folder).generic_string(), "",
                      entry.path().string(), entry.file_size()});
  }
  std::sort(files_.begin(), files_.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.name < b.name; });
}

/// A clip is named after its file: the stem, or where several files share it, the
/// path without the extension, or with it.
void MotionFolder::name_clips() {
  std::unordered_map<std::string, int> stems, paths;
  for (const SourceFile& file : files_) {
    ++stems[fs::path(file.name).stem().string()];
    ++paths[path_without_extension(file.name)];
  }
  for (SourceFile& file : files_) {
    const std::string stem = fs::path(file.name).stem().string();
    const std::string path = path_without_extension(file.name);
    file.key = stems[stem] == 1 ? stem : paths[path] == 1 ? path : file.name;
  }
}

void MotionFolder::match_captions() {
  std::set<const CaptionEntry*> used;
  for (size_t i = 0; i < files_.size(); ++i) {
    const CaptionEntry* entry = captions_.find(files_[i].key);
    if (!entry) entry = captions_.find(path_without_extension(files_[i].name));
    if (!entry) entry = captions_.find(files_[i].name);
    const fs::path path(files_[i].name);
    const bool alone = files_[i].key == path.stem();  // no other file has this stem
    if (!entry && alone) entry = captions_.find(path.filename().string());
    described_.push_back(entry);
    if (entry) {
      used.insert(entry);
    } else if (!captions_.path().empty()) {
      warnings_.push_back(files_[i].name + ": " + captions_.path() +
                          " does not name it: stored without captions, in no split");
    }
  }
  if (captions_.path().empty() && !files_.empty()) {
    warnings_.push_back(options_.folder +
                        ": there is no captions file: all clips are stored without captions, in no "
                        "split");
  }
  warnings_.insert(warnings_.end(), captions_.warnings().begin(), captions_.warnings().end());
  for (const CaptionEntry& entry : captions_.entries()) {
    if (!used.contains(&entry)) {
      warnings_.push_back(captions_.path() + ":" + std::to_string(entry.line) + ": clip '" +
                          entry.clip + "' has no motion file");
    }
  }
}

std::string MotionFolder::fingerprint(size_t i) const {
  std::string parts = content_hash(read_bounded_file(files_[i].path, kMaxMotionBytes));
  if (fs::path(files_[i].path).extension() == ".amc") {
    parts += content_hash(read_bounded_file(formats::find_asf(files_[i].path), kMaxMotionBytes));
  }
  parts += options_fingerprint();
  if (const CaptionEntry* entry = described_[i]) {
    nlohmann::json description = {entry->captions, entry->labels, entry->split};
    // Only where it is used: the fingerprints of other data sets stay.
    if (entry->canonical || !entry->name.empty() || !entry->group.empty() ||
        !entry->licence.empty() || !entry->tags.empty()) {
      description.push_back(
          {entry->name, entry->group, entry->licence, entry->tags, entry->canonical});
    }
    parts += description.dump();
  }
  return content_hash(parts);
}

std::vector<PreparedClip> MotionFolder::prepare(size_t i,
                                                std::vector<std::string>& warnings) const {
  db::Clip clip;
  clip.name = files_[i].key;
  clip.source = options_.source;
  clip.source_file = files_[i].key;
  clip.split = "none";
  clip.licence = options_.licence;
  clip.group = options_.source + "/" + files_[i].key;
  MotionFileOptions reading;
  std::optional<double> labelled_fps;
  if (const CaptionEntry* entry = described_[i]) {
    const ReadingLabels labels(captions_.path(), *entry);
    if (!entry->canonical) {
      reading = labels.options();
      labelled_fps = labels.fps();
    }
    clip.captions = entry->captions;
    clip.labels = entry->labels;
    clip.split = entry->split;
    if (const auto licence = labels.text("licence"); !licence.empty()) clip.licence = licence;
    // Both say that the same performance is there in another skeleton; a trial
    // keeps its number in every conversion.
    if (const auto original = labels.text("duplicate_of"); !original.empty()) clip.group = original;
    if (const auto trial = labels.text("trial"); !trial.empty()) clip.group = "trial/" + trial;
    if (!entry->name.empty()) clip.name = entry->name;
    if (!entry->licence.empty()) clip.licence = entry->licence;
    if (!entry->group.empty()) clip.group = entry->group;
    clip.tags = entry->tags;
    if (entry->canonical) {
      return cut_into_clips(clip, load_stored_motion(files_[i].path), humanml_skeleton(),
                            window_options());
    }
  }
  reading.fps = options_.fps;
  reading.root = options_.root;
  const bool map_is_hint = options_.skeleton_map.empty();
  if (!map_is_hint) reading.skeleton_map = options_.skeleton_map;
  const Motion motion = DescribedFile(files_[i], reading, map_is_hint).load(labelled_fps, warnings);
  return cut_into_clips(clip, motion, humanml_skeleton(), window_options());
}

}  // namespace remomask::exchange
