#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/time.h"
#include "db/database.h"
#include "remomask/library.h"
#include "remomask/progress.h"

namespace remomask::exchange {

struct ImportOptions {
  std::string folder;  ///< of motion files, or of a HumanML3D / KIT-ML data set
  std::string
      captions_file;   ///< JSON Lines; empty: FOLDER.jsonl beside or captions.jsonl in the folder
  std::string source;  ///< name of the data set; default: the folder's name
  std::string licence;
  std::string skeleton_map;   ///< as in MotionFileOptions
  std::optional<double> fps;  ///< likewise, for all files
  std::string root;           ///< likewise
  int min_frames = 20;
  int max_frames = kMaxClipFrames;
  int window_overlap = 40;  ///< frames shared by neighbouring windows of a long clip
  int threads = 1;
};

struct ImportReport {
  int files = 0;         ///< motion files seen
  int files_stored = 0;  ///< files of which at least one clip was stored now
  int files_known = 0;   ///< unchanged since an earlier import
  int clips_stored = 0;
  int clips_windowed = 0;  ///< of them windows of longer files
  uint64_t bytes_read = 0;
  double seconds = 0;
  std::vector<RejectedFile> rejected;  ///< too short, broken, duplicate, unknown skeleton ...
  std::vector<std::string> warnings;   ///< captions without a file, files without captions ...
};

/// Imports a folder of motion files with a captions file, or a HumanML3D /
/// KIT-ML folder as its authors lay it out (new_joint_vecs, new_joints, texts,
/// split files). Goes on where an interrupted import stopped; a second import
/// of the same folder changes nothing.
ImportReport import_folder(db::Database& database, const ImportOptions& options,
                           const Monitor& monitor = {});

}  // namespace remomask::exchange
