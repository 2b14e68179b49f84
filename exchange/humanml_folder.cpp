#include "exchange/humanml_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "base/counted.h"
#include "base/file.h"
#include "base/hash.h"
#include "exchange/humanml_texts.h"
#include "formats/npy.h"
#include "motion/canonical.h"
#include "motion/features.h"
#include "remomask/error.h"
#include "text/encoding.h"

namespace remomask::exchange {

namespace {

namespace fs = std::filesystem;

constexpr const char* kJointsFolder = "new_joints";
constexpr const char* kVectorsFolder = "new_joint_vecs";
constexpr const char* kTextsFolder = "texts";

/// The files with this extension, sorted.
std::vector<fs::path> files_with_extension(const fs::path& folder, const char* extension) {
  std::vector<fs::path> files;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().extension() == extension) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// A motion as the data set holds it, which is canonical already.
std::pair<Motion, const Skeleton*> read_humanml_motion(const std::string& path) {
  formats::NpyArray array = formats::read_npy(path);
  if (array.shape.empty() || array.shape[0] < 1 || array.shape[0] > 1'000'000) {
    throw FileError(path, 0, "has no frames");
  }
  const int frames = static_cast<int>(array.shape[0]);
  for (const Skeleton* skeleton : {&humanml_skeleton(), &kit_skeleton()}) {
    const auto joints = static_cast<size_t>(skeleton->joints());
    if (array.shape == std::vector<size_t>{array.shape[0], joints, 3}) {
      Motion motion(frames, skeleton->joints());
      motion.positions = std::move(array.values);
      return {std::move(motion), skeleton};
    }
    const auto dim = static_cast<size_t>(skeleton->feature_dim());
    if (array.shape == std::vector<size_t>{array.shape[0], dim}) {
      motion::Features features(frames, skeleton->feature_dim());
      features.values = std::move(array.values);
      return {motion::recover_motion(features, *skeleton), skeleton};
    }
  }
  throw FileError(path, 0,
                  fmt::format("has shape ({}); joints (frames x 22 x 3 or 21 x 3) or features "
                              "(frames x 263 or 251) are needed",
                              fmt::join(array.shape, ", ")));
}

std::string without_mirror_mark(const std::string& id) {
  return id.starts_with('M') ? id.substr(1) : id;
}

/// Captions of frames [first, last).
struct CaptionedPart {
  std::string name;
  std::vector<std::string> captions;
};

}  // namespace

bool HumanmlFolder::is_layout_of(const std::string& folder) {
  const fs::path path(folder);
  return fs::is_directory(path / kTextsFolder) &&
         (fs::is_directory(path / kJointsFolder) || fs::is_directory(path / kVectorsFolder));
}

HumanmlFolder::HumanmlFolder(const ImportOptions& options) : MotionSource(options) {
  if (!options_.captions_file.empty()) {
    throw Error(options_.captions_file +
                ": a HumanML3D or KIT-ML folder has its own texts; omit the captions file");
  }
  if (!options_.skeleton_map.empty()) {
    throw Error("a HumanML3D or KIT-ML folder needs no skeleton map; omit the option");
  }
  find_motions();
  read_splits();
  find_texts();
}

void HumanmlFolder::find_motions() {
  std::map<std::string, fs::path> motions;
  const fs::path folder(options_.folder);
  for (const char* kind : {kJointsFolder, kVectorsFolder}) {
    for (const fs::path& path : files_with_extension(folder / kind, ".npy")) {
      motions.emplace(path.stem().string(), path);
    }
  }
  for (const auto& [id, path] : motions) {
    files_.push_back(
        {path.lexically_relative(folder).generic_string(), id, path.string(), fs::file_size(path)});
    known_.insert(id);
  }
}

void HumanmlFolder::read_splits() {
  for (const char* split : {"train", "val", "test"}) {
    const std::string path = (fs::path(options_.folder) / (std::string(split) + ".txt")).string();
    if (!fs::exists(path)) {
      warnings_.push_back(path + ": is missing: no clip is in the split '" + split + "'");
      continue;
    }
    std::istringstream lines(text::read_lines_file(path));
    std::unordered_map<std::string, long> seen;
    std::string id;
    for (long line = 1; std::getline(lines, id); ++line) {
      const auto is_blank = [](char c) { return c == '\r' || c == ' ' || c == '\t'; };
      id.erase(std::remove_if(id.begin(), id.end(), is_blank), id.end());
      if (id.ends_with(".npy")) id.resize(id.size() - 4);
      if (id.empty()) continue;
      const std::string where = path + ":" + std::to_string(line) + ": clip '" + id + "' ";
      const auto [earlier, first_time] = seen.emplace(id, line);
      if (!first_time) {
        warnings_.push_back(where + "is listed in line " + std::to_string(earlier->second) +
                            " already");
      } else if (!known_.contains(id)) {
        warnings_.push_back(where + "has no motion file");
      } else if (const auto [other, is_new] = splits_.emplace(id, split);
                 !is_new && other->second != split) {
        warnings_.push_back(where + "is in the split '" + other->second + "' already and stays " +
                            "there");
      }
    }
  }
}

void HumanmlFolder::find_texts() {
  for (const fs::path& path :
       files_with_extension(fs::path(options_.folder) / kTextsFolder, ".txt")) {
    const std::string id = path.stem().string();
    with_text_.insert(id);
    if (!known_.contains(id)) warnings_.push_back(path.string() + ": has no motion file");
  }
  for (const std::string& id : known_) {
    if (!with_text_.contains(id)) {
      warnings_.push_back(text_path(id) + ": is missing: '" + id +
                          "' is stored without captions, in no split");
    }
  }
}

std::string HumanmlFolder::text_path(const std::string& id) const {
  return (fs::path(options_.folder) / kTextsFolder / (id + ".txt")).string();
}

std::string HumanmlFolder::fingerprint(size_t i) const {
  std::string parts = content_hash(read_file(files_[i].path)) + options_fingerprint();
  if (with_text_.contains(files_[i].key))
    parts += content_hash(read_file(text_path(files_[i].key)));
  const auto split = splits_.find(files_[i].key);
  return content_hash(parts + (split == splits_.end() ? "" : split->second));
}

std::vector<PreparedClip> HumanmlFolder::prepare(size_t i,
                                                 std::vector<std::string>& warnings) const {
  const std::string& id = files_[i].key;
  const auto [motion, skeleton] = read_humanml_motion(files_[i].path);
  db::Clip clip;
  clip.name = id;
  clip.source = options_.source;
  clip.source_file = id;
  clip.licence = options_.licence;
  clip.group = options_.source + "/" + without_mirror_mark(id);
  clip.mirrored = id.starts_with('M');
  clip.split = "none";
  const auto split = splits_.find(id);
  const bool has_text = with_text_.contains(id);
  if (has_text && split != splits_.end()) clip.split = split->second;
  if (!has_text) return cut_into_clips(clip, motion, *skeleton, window_options());

  // Tags that mean the same frames give one clip.
  std::map<std::pair<int, int>, CaptionedPart> parts;
  for (const TimedCaptions& timed : read_humanml_texts(text_path(id), warnings)) {
    const bool whole = timed.to == 0;
    const std::string name = whole ? id : fmt::format("{}@{}-{}", id, timed.from, timed.to);
    const int first = static_cast<int>(timed.from * skeleton->fps);
    const int last =
        whole ? motion.frames
              : static_cast<int>(std::min<double>(timed.to * skeleton->fps, motion.frames));
    if (!whole && last - first < options_.min_frames) {
      warnings.push_back(
          fmt::format("{}: part {} has {}, at least {} are needed: left out", text_path(id), name,
                      counted(std::max(0, last - first), "frame"), options_.min_frames));
      continue;
    }
    auto& part = parts.emplace(std::pair(first, last), CaptionedPart{name, {}}).first->second;
    if (whole) part.name = name;
    part.captions.insert(part.captions.end(), timed.captions.begin(), timed.captions.end());
  }
  if (parts.empty()) throw FileError(text_path(id), 0, "has no usable caption");

  std::vector<PreparedClip> prepared;
  for (const auto& [frames, part] : parts) {
    const auto [first, last] = frames;
    db::Clip own = clip;
    own.name = part.name;
    own.captions = part.captions;
    own.start_frame = first;
    const bool is_part = first > 0 || last < motion.frames;
    // A part keeps its height above the floor of the whole motion.
    const Motion piece = is_part ? motion::canonicalize(slice(motion, first, last), *skeleton,
                                                        {.uniform_skeleton = false, .floor = false})
                                 : motion;
    for (PreparedClip& item : cut_into_clips(own, piece, *skeleton, window_options())) {
      prepared.push_back(std::move(item));
    }
  }
  return prepared;
}

}  // namespace remomask::exchange
