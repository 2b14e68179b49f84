#include "db/sqlite.h"

#include <unistd.h>

#include <bit>
#include <cstring>
#include <filesystem>

#include "db/page_checksums.h"
#include "remomask/error.h"

namespace remomask::db {

static_assert(std::endian::native == std::endian::little, "stored floats are little-endian");

namespace {

constexpr int kBusyMilliseconds = 5000;
constexpr int kMaxValueBytes = 64 << 20;  // a motion of 200 frames has 52 kB
constexpr int kStepsBetweenStopChecks = 100000;

/// Characters that a URI file name may not hold as they are.
std::string uri_of_path(const std::string& path) {
  std::string uri = "file:";
  for (const char c : path) {
    if (c == '%' || c == '?' || c == '#') {
      constexpr char kDigits[] = "0123456789abcdef";
      uri += '%';
      uri += kDigits[static_cast<unsigned char>(c) >> 4];
      uri += kDigits[static_cast<unsigned char>(c) & 15];
    } else {
      uri += c;
    }
  }
  return uri;
}

std::string sqlite_remedy(int code) {
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return "another program is writing to it; wait until it has finished, then try again";
    case SQLITE_FULL:
      return "the disk is full; free some space and run the same command again, what was "
             "committed before is safe";
    case SQLITE_IOERR:
      if (code == SQLITE_IOERR_DATA) {
        return "a page of the file is damaged (its checksum differs); restore a snapshot";
      }
      return "the disk cannot be read or written; check its free space and its health";
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      return "it cannot be written; check the permissions of the file and its folder, or copy it";
    case SQLITE_CANTOPEN:
      return "check that the path exists and that you may read and write it and its folder";
    case SQLITE_NOTADB:
      return "it is not a motion database; check the path";
    case SQLITE_CORRUPT:
      return "it is damaged; restore a backup, or save what is left with the sqlite3 program's "
             "'.recover'";
    case SQLITE_NOMEM:
      return "there is not enough memory; close other programs";
    case SQLITE_TOOBIG:
      return "a value is larger than 64 MB; cut the motion into shorter clips, or shorten the text";
    default:
      return "check the file with the sqlite3 program's 'PRAGMA integrity_check'";
  }
}

}  // namespace

SqliteConnection::SqliteConnection(std::string path, SqliteMode mode) : path_(std::move(path)) {
  const bool exists = std::filesystem::exists(path_);
  if (!exists && mode != SqliteMode::create) {
    throw Error(path_ + ": there is no such database; check the path, or make one by an import");
  }
  if (exists && std::filesystem::is_directory(path_)) {
    throw Error(path_ + ": is a folder; name the database file itself");
  }
  // Opening a pipe would wait for its writer.
  if (exists && !std::filesystem::is_regular_file(path_)) {
    throw Error(path_ + ": is not a regular file; name the database file itself");
  }
  if (exists && mode != SqliteMode::read_only && ::access(path_.c_str(), W_OK) != 0) {
    throw Error(path_ + ": cannot be written; check its permissions, or copy it");
  }
  const std::string uri = uri_of_path(path_);
  try {
    if (mode == SqliteMode::read_only) {
      open_for_reading(uri);
    } else {
      open(uri, SQLITE_OPEN_READWRITE | (mode == SqliteMode::create ? SQLITE_OPEN_CREATE : 0));
    }
    sqlite3_busy_timeout(handle_, kBusyMilliseconds);
    distrust();
    execute("PRAGMA foreign_keys = ON");
  } catch (...) {
    close();
    throw;
  }
}

SqliteConnection::~SqliteConnection() { close(); }

void SqliteConnection::open(const std::string& uri, int flags) {
  const int code = sqlite3_open_v2(
      uri.c_str(), &handle_, flags | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, page_checksum_vfs());
  if (!handle_) fail(code);
  if (code != SQLITE_OK) fail();
  // Else what reads the schema forgets that a page was damaged.
  sqlite3_extended_result_codes(handle_, 1);
}

void SqliteConnection::open_for_reading(const std::string& uri) {
  const std::string folder = std::filesystem::absolute(path_).parent_path().string();
  const bool folder_is_writable = ::access(folder.c_str(), W_OK) == 0;
  if (folder_is_writable && ::access(path_.c_str(), W_OK) == 0) {
    // Readers of a WAL database make two files beside it. SQLite lets only a connection that
    // could write remove them when it is the last one to close, or play back the journal of a
    // killed program. The pragma refuses every change of the content.
    open(uri, SQLITE_OPEN_READWRITE);
    execute("PRAGMA query_only = ON");
    return;
  }
  // Where those files cannot be made, nobody else writes either: the file does not change.
  const bool unchanging = !folder_is_writable && !std::filesystem::exists(path_ + "-wal");
  open(unchanging ? uri + "?immutable=1" : uri, SQLITE_OPEN_READONLY);
}

void SqliteConnection::distrust() {
  sqlite3_db_config(handle_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(handle_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_limit(handle_, SQLITE_LIMIT_LENGTH, kMaxValueBytes);
}

void SqliteConnection::trust_schema() const {
  sqlite3_db_config(handle_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 1, nullptr);
}

void SqliteConnection::stop_when(std::function<bool()> stop) {
  stop_ = std::move(stop);
  sqlite3_progress_handler(
      handle_, kStepsBetweenStopChecks,
      [](void* self) { return static_cast<SqliteConnection*>(self)->stop_() ? 1 : 0; }, this);
}

void SqliteConnection::close() {
  sqlite3_close_v2(handle_);
  handle_ = nullptr;
}

void SqliteConnection::fail() const {
  const int code = sqlite3_extended_errcode(handle_);
  if ((code & 0xff) == SQLITE_INTERRUPT) throw Interrupted("reading " + path_ + " was stopped");
  throw Error(path_ + ": " + sqlite3_errmsg(handle_) + ": " + sqlite_remedy(code));
}

void SqliteConnection::fail(int code) const {
  throw Error(path_ + ": " + sqlite3_errstr(code) + ": " + sqlite_remedy(code));
}

void SqliteConnection::execute(const char* sql) const {
  if (sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

int64_t SqliteConnection::integer(const char* sql) const {
  SqliteStatement statement(*this, sql);
  if (!statement.step()) throw Error(path_ + ": '" + sql + "' gives no value");
  return statement.integer(0);
}

SqliteStatement::SqliteStatement(const SqliteConnection& connection, const char* sql)
    : connection_(connection) {
  check(sqlite3_prepare_v2(connection.handle(), sql, -1, &statement_, nullptr));
}

void SqliteStatement::check(int code) const {
  if (code != SQLITE_OK) connection_.fail();
}

SqliteStatement& SqliteStatement::bind(int parameter, int64_t value) {
  check(sqlite3_bind_int64(statement_, parameter, value));
  return *this;
}

SqliteStatement& SqliteStatement::bind(int parameter, std::string_view value) {
  check(sqlite3_bind_text64(statement_, parameter, value.data() ? value.data() : "", value.size(),
                            SQLITE_TRANSIENT, SQLITE_UTF8));
  return *this;
}

SqliteStatement& SqliteStatement::bind(int parameter, std::span<const float> values) {
  if (values.empty()) {
    check(sqlite3_bind_zeroblob(statement_, parameter, 0));
  } else {
    check(sqlite3_bind_blob64(statement_, parameter, values.data(), values.size_bytes(),
                              SQLITE_TRANSIENT));
  }
  return *this;
}

SqliteStatement& SqliteStatement::bind_real(int parameter, double value) {
  check(sqlite3_bind_double(statement_, parameter, value));
  return *this;
}

SqliteStatement& SqliteStatement::bind_pointer(int parameter, void* pointer, const char* type) {
  check(sqlite3_bind_pointer(statement_, parameter, pointer, type, nullptr));
  return *this;
}

bool SqliteStatement::step() {
  const int code = sqlite3_step(statement_);
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) connection_.fail();
  return false;
}

void SqliteStatement::run() {
  step();
  check(sqlite3_reset(statement_));
}

std::string SqliteStatement::text(int column) const {
  const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
  return data ? std::string(data, static_cast<size_t>(sqlite3_column_bytes(statement_, column)))
              : std::string();
}

std::vector<float> SqliteStatement::floats(int column) const {
  const void* data = sqlite3_column_blob(statement_, column);
  const auto bytes = static_cast<size_t>(sqlite3_column_bytes(statement_, column));
  if (bytes % sizeof(float) != 0) {
    throw Error(connection_.path() + ": a stored vector is cut off: the database is damaged; " +
                "restore a backup");
  }
  std::vector<float> values(bytes / sizeof(float));
  if (bytes > 0) std::memcpy(values.data(), data, bytes);
  return values;
}

SqliteScope::SqliteScope(const SqliteConnection& connection)
    : connection_(connection), nested_(connection.in_transaction()) {
  connection_.execute(nested_ ? "SAVEPOINT remomask_scope" : "BEGIN IMMEDIATE");
}

SqliteScope::~SqliteScope() {
  // After some errors (a full disk) SQLite has rolled back on its own.
  if (done_ || !connection_.in_transaction()) return;
  const char* sql = nested_ ? "ROLLBACK TO remomask_scope; RELEASE remomask_scope" : "ROLLBACK";
  sqlite3_exec(connection_.handle(), sql, nullptr, nullptr, nullptr);
}

void SqliteScope::commit() {
  connection_.execute(nested_ ? "RELEASE remomask_scope" : "COMMIT");
  done_ = true;
}

}  // namespace remomask::db
