#pragma once

#include <string>

#include "remomask/progress.h"

namespace remomask::db {

/// Copies a database, while other programs read and write it, as it is at one
/// moment into one file that appears complete or not at all. Throws Error when
/// `target` exists and `replace` is false; Interrupted when stopped.
void snapshot_database(const std::string& path, const std::string& target, bool replace,
                       const Monitor& monitor = {});

struct RestoreReport {
  std::string set_aside;  ///< where the old file is, when it was too damaged to be written
};

/// Puts a snapshot in the place of a database, at once: programs that read it see
/// all of the old or all of the new content, and on any failure the old one
/// stays. The restored database has a new identity, so that an index of the old
/// one is never taken for its own. Throws Error when `path` exists and
/// `replace` is false, when the snapshot is damaged or no database, and when
/// another program is writing; Interrupted when stopped.
RestoreReport restore_database(const std::string& snapshot, const std::string& path, bool replace,
                               const Monitor& monitor = {});

}  // namespace remomask::db
