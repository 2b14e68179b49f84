#pragma once

#include <cstdint>
#include <string>

namespace remomask::db {

struct UpgradeReport {
  int64_t version_before = 0, version = 0;  ///< of the file format
  uint64_t bytes_before = 0, bytes = 0;     ///< of the file
};

/// Brings a database to the present format, makes its
/// full-text index anew and gives unused pages back to the disk. An index of it stays valid. Throws
/// Error as Database() does; the old content stays then.
/// `accept_changes`: pages are taken as they are, whatever their checksums say, after another
/// program has written to the file.
UpgradeReport upgrade_database(const std::string& path, bool accept_changes = false);

}  // namespace remomask::db
