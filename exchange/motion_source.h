#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "db/database.h"
#include "exchange/clip_windows.h"
#include "exchange/import.h"

namespace remomask::exchange {

/// A motion file of a data set.
struct SourceFile {
  std::string name;  ///< path in the data set, for messages
  std::string key;   ///< unique in the data set: Clip::source_file, and its note of the import
  std::string path;
  uint64_t bytes = 0;
};

/// A clip that is ready to be stored.
struct PreparedClip {
  db::Clip clip;
  Motion motion;
};

/// A data set on disk in one of the supported layouts. Its const functions
/// may be called from several threads.
class MotionSource {
 public:
  explicit MotionSource(const ImportOptions& options) : options_(options) {}
  virtual ~MotionSource() = default;
  MotionSource(const MotionSource&) = delete;
  MotionSource& operator=(const MotionSource&) = delete;

  /// In the order in which they are stored.
  const std::vector<SourceFile>& files() const { return files_; }
  /// Warnings about the data set as a whole.
  const std::vector<std::string>& warnings() const { return warnings_; }
  const ImportOptions& options() const { return options_; }

  /// Hash of everything that decides what is stored for file number `i`.
  virtual std::string fingerprint(size_t i) const = 0;
  /// Its clips. Throws Error with the reason if the file cannot be used.
  virtual std::vector<PreparedClip> prepare(size_t i, std::vector<std::string>& warnings) const = 0;

 protected:
  WindowOptions window_options() const {
    return {options_.min_frames, options_.max_frames, options_.window_overlap};
  }
  /// The part of the fingerprint that the options decide.
  std::string options_fingerprint() const;

  ImportOptions options_;
  std::vector<SourceFile> files_;
  std::vector<std::string> warnings_;
};

/// Cuts `motion` into the windows of the options, each brought to canonical
/// place and heading when there are several; `clip` names and describes the
/// whole. Throws Error for a motion that is too short.
std::vector<PreparedClip> cut_into_clips(const db::Clip& clip, const Motion& motion,
                                         const Skeleton& skeleton, const WindowOptions& options);

}  // namespace remomask::exchange
