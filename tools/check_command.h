#pragma once

#include <string>
#include <vector>

namespace remomask::tools {

/// What `remomask check` found in one file.
struct CheckedFile {
  std::string kind = "";                  ///< "database", "index", "model", "checkpoint", ...
  std::string content = "";               ///< how much it holds, for people
  bool has_checksums = true;              ///< false: written by a version that had none
  std::vector<std::string> defects = {};  ///< with what to do; empty: in order
};

/// For files that need libtorch or FAISS to be read: models, checkpoints, indexes. Throws FileError
/// with the damage.
CheckedFile check_core_file(const std::string& path);

}  // namespace remomask::tools
