#include "db/database.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>

#include "db/database_impl.h"
#include "db/schema.h"
#include "remomask/error.h"

namespace remomask::db {

namespace {

SqliteMode sqlite_mode(OpenMode mode) {
  switch (mode) {
    case OpenMode::read_only:
      return SqliteMode::read_only;
    case OpenMode::read_write:
      return SqliteMode::read_write;
    case OpenMode::create:
      return SqliteMode::create;
  }
  throw Error("unknown way to open a database");
}

/// Device and number of the file, nothing where there is none.
std::pair<dev_t, ino_t> file_identity(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return {status.st_dev, status.st_ino};
}

}  // namespace

void Database::Impl::require_same_file() const {
  if (file_identity(connection.path()) == file) return;
  throw Error(connection.path() +
              ": was removed or replaced while it was written; what was stored is lost. Run the "
              "same command again");
}

Database::Impl::Impl(const std::string& path, OpenMode mode)
    : connection(path, sqlite_mode(mode)), file(file_identity(path)) {
  if (mode == OpenMode::create && is_empty_database(connection)) create_schema(connection);
  check_schema(connection);
  if (mode == OpenMode::read_only) {
    require_readable_schema(connection);
  } else {
    // WAL keeps the file whole at any kill; only a power cut can lose the last
    // commits, and an import repeats those.
    connection.execute("PRAGMA synchronous = NORMAL");
    upgrade_schema(connection);
  }
}

Database::Database(const std::string& path, OpenMode mode)
    : impl_(std::make_unique<Impl>(path, mode)) {}
Database::~Database() = default;
Database::Database(Database&&) noexcept = default;
Database& Database::operator=(Database&&) noexcept = default;

const std::string& Database::path() const { return impl_->connection.path(); }
std::string Database::uuid() const { return impl_->required_fact("uuid"); }
int64_t Database::generation() const {
  return impl_->connection.integer(
      "SELECT CAST(value AS INTEGER) FROM fact WHERE key = 'generation'");
}

std::string Database::writer_of(int64_t generation) const {
  if (!impl_->logs_changes()) return "";
  SqliteStatement row(impl_->connection,
                      "SELECT token FROM writer WHERE generation <= ? "
                      "ORDER BY generation DESC LIMIT 1");
  row.bind(1, generation);
  return row.step() ? row.text(0) : "";
}

void Database::begin() { impl_->connection.execute("BEGIN IMMEDIATE"); }
void Database::commit() {
  impl_->connection.execute("COMMIT");
  impl_->require_same_file();
}
void Database::rollback() {
  // After some errors SQLite has rolled back on its own.
  if (impl_->connection.in_transaction()) impl_->connection.execute("ROLLBACK");
}

bool Database::file_is_imported(const std::string& source, const std::string& file,
                                const std::string& fingerprint) const {
  SqliteStatement row(impl_->connection,
                      "SELECT fingerprint FROM import_log WHERE source = ? AND file = ?");
  row.bind(1, source).bind(2, file);
  return row.step() && row.text(0) == fingerprint;
}

void Database::note_imported_file(const std::string& source, const std::string& file,
                                  const std::string& fingerprint, const std::string& outcome) {
  SqliteStatement(impl_->connection, "INSERT OR REPLACE INTO import_log VALUES (?, ?, ?, ?)")
      .bind(1, source)
      .bind(2, file)
      .bind(3, fingerprint)
      .bind(4, outcome)
      .run();
}

std::map<std::string, std::string> Database::imported_files(const std::string& source) const {
  std::map<std::string, std::string> files;
  SqliteStatement rows(impl_->connection,
                       "SELECT file, fingerprint FROM import_log WHERE source = ?");
  rows.bind(1, source);
  while (rows.step()) files[rows.text(0)] = rows.text(1);
  return files;
}

void Database::set_fact(const std::string& key, const std::string& value) {
  const std::array own = {"uuid", "generation", "changes_since", "motion_format"};
  if (std::find(own.begin(), own.end(), key) != own.end()) {
    throw Error("the fact '" + key + "' belongs to the database itself; choose another key");
  }
  SqliteStatement(impl_->connection, "INSERT OR REPLACE INTO fact VALUES (?, ?)")
      .bind(1, key)
      .bind(2, value)
      .run();
}

std::optional<std::string> Database::fact(const std::string& key) const { return impl_->fact(key); }

struct ReadSnapshot::Impl {
  const SqliteConnection& connection;
  bool was_query_only;
};

ReadSnapshot::ReadSnapshot(const Database& database) {
  const SqliteConnection& connection = database.impl_->connection;
  if (connection.in_transaction()) return;  // which sees one state already
  const bool query_only = connection.integer("PRAGMA query_only") != 0;
  connection.execute("BEGIN");
  impl_ = std::make_unique<Impl>(Impl{connection, query_only});
  // What would be written inside would be lost with the snapshot.
  connection.execute("PRAGMA query_only = ON");
  // SQLite fixes the state at the first read, not at BEGIN.
  database.generation();
}

ReadSnapshot::~ReadSnapshot() {
  // Nothing was written: there is nothing that could fail to be stored.
  if (!impl_) return;
  const char* sql = impl_->was_query_only ? "COMMIT" : "COMMIT; PRAGMA query_only = OFF";
  sqlite3_exec(impl_->connection.handle(), sql, nullptr, nullptr, nullptr);
}

}  // namespace remomask::db
