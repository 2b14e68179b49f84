#include "db/storing_database.h"

#include <filesystem>

#include "db/schema.h"
#include "db/sqlite.h"

namespace remomask::db {

namespace {

bool is_unused(const SqliteConnection& connection) {
  return is_empty_database(connection) ||
         connection.integer("SELECT CAST(value AS INTEGER) FROM fact WHERE key = 'generation'") ==
             0;
}

/// Removes the file unless something was stored in it, or another program has it
/// open: leaving the WAL needs to be alone with the file.
void remove_when_unused(const std::string& path) {
  const SqliteConnection connection(path, SqliteMode::read_write);
  if (!is_unused(connection)) return;
  SqliteStatement leave_wal(connection, "PRAGMA journal_mode = DELETE");
  leave_wal.step();
  if (leave_wal.text(0) != "delete") return;
  leave_wal.reset();
  connection.execute("BEGIN EXCLUSIVE");
  if (is_unused(connection)) std::filesystem::remove(path);
  connection.execute("COMMIT");
}

}  // namespace

StoringDatabase::StoringDatabase(const std::string& path)
    : path_(path), is_new_(!std::filesystem::exists(path)) {
  try {
    // A file without tables is what a process leaves that was killed while it made them.
    database_.emplace(path, OpenMode::create);
  } catch (...) {
    take_away_unused();
    throw;
  }
}

StoringDatabase::~StoringDatabase() {
  database_.reset();
  take_away_unused();
}

void StoringDatabase::take_away_unused() const {
  if (!is_new_ || !std::filesystem::exists(path_)) return;
  try {
    remove_when_unused(path_);
  } catch (const std::exception&) {
    // Another program uses it already: it stays.
  }
}

}  // namespace remomask::db
