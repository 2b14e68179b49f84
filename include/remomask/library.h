#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "remomask/export.h"
#include "remomask/progress.h"

namespace remomask {

/// Path of a file that is shipped with remomask ("base.safetensors", "motions.sqlite"): in
/// the folder that $REMOMASK_MODELS names, or where remomask was installed. Throws Error if it
/// is not there.
REMOMASK_API std::string shipped_file(const std::string& name);
/// The shipped model and the shipped database.
REMOMASK_API std::string shipped_model();
REMOMASK_API std::string shipped_database();

/// How motion files become clips of a database.
struct AddOptions {
  std::string source = "added";       ///< data set that the clips belong to
  std::vector<std::string> captions;  ///< of every file; the generator reads no clip without one
  std::vector<std::string> tags;
  std::string licence;
  std::string split = "none";  ///< "train", "val", "test" or "none"
};

/// A file that was left out, and why.
struct RejectedFile {
  std::string file, reason;
};

/// What became of the files.
struct AddReport {
  std::vector<std::string> clips;  ///< names of the clips that were added
  std::vector<RejectedFile> rejected;
};

/// Adds motion files (.bvh, .npy) to a database, which is created if it does not exist. Each file
/// is stored whole or not at all; one that cannot be read, or whose motion or name the database
/// already has, is reported and left out. Throws Interrupted if asked to stop; the files before
/// stay added.
REMOMASK_API AddReport add_motion_files(const std::string& database,
                                        std::span<const std::string> files,
                                        const AddOptions& options = {},
                                        const Monitor& monitor = {});

/// What an update of an index did.
struct IndexReport {
  int64_t embedded = 0;  ///< clips that the retriever embedded
  int64_t indexed = 0;   ///< clips in the index now
};

/// Embeds the clips that are new and brings the index beside the database up to date. An open
/// TextToMotion finds the new clips from its next call on. Throws Interrupted if asked to stop;
/// the next call continues.
REMOMASK_API IndexReport index_database(const std::string& database, const std::string& model,
                                        const Monitor& monitor = {});

}  // namespace remomask
