#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <unordered_map>
#include <vector>

namespace remomask::exchange {

/// One line of a captions file.
struct CaptionEntry {
  std::string clip;  ///< file stem, or path in the folder, with or without its extension
  std::vector<std::string> captions;
  nlohmann::json labels = nlohmann::json::object();
  std::string split = "none";
  std::string name, group, licence;  ///< of the clip; empty: as the import chooses
  std::vector<std::string> tags;
  /// The file holds stored positions, which are taken as they are: its labels describe
  /// how the original file was to be read.
  bool canonical = false;
  long line = 0;
};

/// Captions of a folder of motion files: JSON Lines of
/// {"clip": "...", "captions": ["..."], "labels": {...}, "split": "train|val|test|none"}
/// (one caption needs no list), and, as an export writes them, "name", "group", "licence", "tags",
/// "canonical".
class CaptionsFile {
 public:
  CaptionsFile() = default;
  /// A line that is not such a line, or gives a clip for a second time, is left
  /// out with a warning that names it. Throws FileError if no line can be used.
  explicit CaptionsFile(const std::string& path);

  const std::string& path() const { return path_; }
  const std::vector<CaptionEntry>& entries() const { return entries_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// nullptr if the file does not name the clip.
  const CaptionEntry* find(const std::string& clip) const;

 private:
  void add(CaptionEntry entry);

  std::string path_;
  std::vector<std::string> warnings_;
  std::vector<CaptionEntry> entries_;
  std::unordered_map<std::string, size_t> places_;
};

}  // namespace remomask::exchange
