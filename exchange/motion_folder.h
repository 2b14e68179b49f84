#pragma once

#include "exchange/captions_file.h"
#include "exchange/motion_source.h"

namespace remomask::exchange {

/// A folder of motion files of any type that load_motion() reads, at any depth, with one captions
/// file.
class MotionFolder : public MotionSource {
 public:
  /// options.source and options.captions_file are filled in (the latter may be
  /// empty: no captions).
  explicit MotionFolder(const ImportOptions& options);

  std::string fingerprint(size_t i) const override;
  std::vector<PreparedClip> prepare(size_t i, std::vector<std::string>& warnings) const override;

 private:
  void find_files();
  void name_clips();
  void match_captions();

  CaptionsFile captions_;
  std::vector<const CaptionEntry*> described_;  ///< of each file, or nullptr
};

}  // namespace remomask::exchange
