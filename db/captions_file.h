#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <unordered_map>
#include <vector>

namespace remomask {

/// One line of a captions file.
struct CaptionEntry {
  std::string clip;  ///< file stem, or path in the folder without extension
  std::vector<std::string> captions;
  nlohmann::json labels = nlohmann::json::object();
  std::string split = "none";
  long line = 0;
};

/// Captions of a folder of motion files: JSON Lines of
/// {"clip": "...", "captions": ["..."], "labels": {...}, "split": "train|val|test|none"}.
class CaptionsFile {
 public:
  CaptionsFile() = default;
  /// Throws FileError with the line for anything that is not such a line, or a
  /// clip that is given twice.
  explicit CaptionsFile(const std::string& path);

  const std::string& path() const { return path_; }
  const std::vector<CaptionEntry>& entries() const { return entries_; }
  /// nullptr when the clip is not there.
  const CaptionEntry* find(const std::string& clip) const;

 private:
  std::string path_;
  std::vector<CaptionEntry> entries_;
  std::unordered_map<std::string, size_t> places_;
};

}  // namespace remomask
