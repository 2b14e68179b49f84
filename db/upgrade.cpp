#include "db/upgrade.h"

#include <filesystem>

#include "db/schema.h"
#include "db/sqlite.h"

namespace remomask::db {

UpgradeReport upgrade_database(const std::string& path) {
  UpgradeReport report;
  report.version = kSchemaVersion;
  const SqliteConnection connection(path, SqliteMode::read_write);
  check_schema(connection);
  report.version_before = connection.integer("PRAGMA user_version");
  report.bytes_before = std::filesystem::file_size(path);
  upgrade_schema(connection);
  // Mends a full-text index that is out of step with the captions.
  connection.execute("INSERT INTO caption_words (caption_words) VALUES ('rebuild')");
  connection.execute("VACUUM");
  // In WAL mode the file itself shrinks at a checkpoint.
  connection.execute("PRAGMA wal_checkpoint(TRUNCATE)");
  report.bytes = std::filesystem::file_size(path);
  return report;
}

}  // namespace remomask::db
