#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "db/database.h"
#include "exchange/clip_windows.h"
#include "exchange/import.h"

namespace remomask::exchange {

/// What the clips of added files have in common.
struct AddOptions {
  std::string source = "added";
  std::vector<std::string> captions, tags;
  nlohmann::json labels = nlohmann::json::object();
  std::string split = "none";
  std::string licence;
  std::string skeleton_map;   ///< as in MotionFileOptions
  std::optional<double> fps;  ///< likewise
  std::string root;           ///< likewise
  WindowOptions windows;
};

struct AddReport {
  std::vector<std::pair<int64_t, std::string>> clips;  ///< ids and names, stored
  std::vector<RejectedFile> rejected;
  std::vector<std::string> warnings;  ///< what was odd about files that were read all the same
};

/// Stores single motion files; a clip is named after its file. The clips of
/// one file are stored together or not at all; a file that cannot be read, whose
/// name is taken, or whose motion is already stored is reported and left out.
AddReport add_files(db::Database& database, const std::vector<std::string>& files,
                    const AddOptions& options);

}  // namespace remomask::exchange
