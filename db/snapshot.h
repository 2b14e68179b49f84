#pragma once

#include <string>

#include "remomask/progress.h"

namespace remomask::db {

/// Copies the state of a database at one moment, while other programs read and write it, into one
/// file that appears complete or not at all. Throws Error if `target` exists and `replace` is
/// false, and Interrupted if stopped.
void snapshot_database(const std::string& path, const std::string& target, bool replace,
                       const Monitor& monitor = {});

struct RestoreReport {
  std::string set_aside;  ///< where the old file is, if it was too damaged to be overwritten
};

/// Replaces a database by a snapshot atomically: programs that read it see either
/// the old or the new content, and on any failure the old content
/// stays. The restored database has a new identity, so that an index of the old
/// one is never mistaken for its own. Throws Error if `path` exists and
/// `replace` is false, if the snapshot is damaged or not a database, and if
/// another program is writing; throws Interrupted if stopped.
RestoreReport restore_database(const std::string& snapshot, const std::string& path, bool replace,
                               const Monitor& monitor = {});

}  // namespace remomask::db
