#pragma once

#include <cstdint>
#include <string>

namespace remomask::db {

struct UpgradeReport {
  int64_t version_before = 0, version = 0;  ///< of the file format
  uint64_t bytes_before = 0, bytes = 0;     ///< of the file
};

/// Upgrades a database to the current format in one transaction, rebuilds its full-text index and
/// returns unused pages to the disk. An index of it stays valid. Throws Error as Database() does;
/// the old content then stays.
UpgradeReport upgrade_database(const std::string& path);

}  // namespace remomask::db
