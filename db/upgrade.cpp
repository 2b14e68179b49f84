#include "db/upgrade.h"

#include <filesystem>

#include "db/page_checksums.h"
#include "db/schema.h"
#include "db/sqlite.h"

namespace remomask::db {

UpgradeReport upgrade_database(const std::string& path, bool accept_changes) {
  UpgradeReport report;
  report.version = kSchemaVersion;
  const SqliteConnection connection(path, SqliteMode::read_write);
  if (accept_changes) ignore_page_checksums(connection.handle());
  check_schema(connection);
  report.version_before = connection.integer("PRAGMA user_version");
  report.bytes_before = std::filesystem::file_size(path);
  upgrade_schema(connection);
  // Mends a full-text index that is out of step with the captions.
  connection.execute("INSERT INTO caption_words (caption_words) VALUES ('rebuild')");
  SqliteStatement mode(connection, "PRAGMA journal_mode");
  mode.step();
  const bool has_log = mode.text(0) == "wal";  // a snapshot has none
  mode.reset();
  seal_pages(connection);
  if (!has_log) connection.execute("PRAGMA journal_mode = DELETE");
  report.bytes = std::filesystem::file_size(path);
  return report;
}

}  // namespace remomask::db
