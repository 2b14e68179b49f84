#pragma once

#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace remomask::db {

enum class SqliteMode { read_only, read_write, create };

/// One connection. Every failure becomes an Error that names the file, what
/// SQLite says, and what to do about it.
class SqliteConnection {
 public:
  SqliteConnection(std::string path, SqliteMode mode);
  ~SqliteConnection();
  SqliteConnection(const SqliteConnection&) = delete;
  SqliteConnection& operator=(const SqliteConnection&) = delete;

  const std::string& path() const { return path_; }
  void execute(const char* sql) const;
  int64_t integer(const char* sql) const;
  int64_t last_insert_id() const { return sqlite3_last_insert_rowid(handle_); }
  /// Rows that the last statement inserted, changed or deleted.
  int64_t changes() const { return sqlite3_changes64(handle_); }
  bool in_transaction() const { return sqlite3_get_autocommit(handle_) == 0; }
  [[noreturn]] void fail() const;
  /// For calls that return their error code instead of keeping it in the connection.
  [[noreturn]] void fail(int code) const;
  sqlite3* handle() const { return handle_; }
  /// Lets triggers use the full-text index, once the schema is known to be ours.
  void trust_schema() const;
  /// Statements that run from now on end with Interrupted soon after `stop` returns true.
  void stop_when(std::function<bool()> stop);

 private:
  /// Files may come from strangers: their schema cannot call what has effects, and values stay
  /// small enough to be held in memory.
  void distrust();
  void open(const std::string& uri, int flags);
  void open_for_reading(const std::string& uri);
  void close();

  std::string path_;
  sqlite3* handle_ = nullptr;
  std::function<bool()> stop_;
};

/// One prepared statement. Parameters count from 1, columns from 0, as in SQLite.
class SqliteStatement {
 public:
  SqliteStatement(const SqliteConnection& connection, const char* sql);
  ~SqliteStatement() { sqlite3_finalize(statement_); }
  SqliteStatement(const SqliteStatement&) = delete;
  SqliteStatement& operator=(const SqliteStatement&) = delete;

  SqliteStatement& bind(int parameter, int64_t value);
  SqliteStatement& bind(int parameter, std::string_view value);
  SqliteStatement& bind(int parameter, std::span<const float> values);
  /// Has its own name because an int would match bind(double) as well as bind(int64_t).
  SqliteStatement& bind_real(int parameter, double value);
  /// A pointer of this type for a function that takes such.
  SqliteStatement& bind_pointer(int parameter, void* pointer, const char* type);
  /// True when there is a row.
  bool step();
  /// For statements without rows; the statement can be bound and run again.
  void run();
  /// Ready to be bound and stepped again.
  void reset() { sqlite3_reset(statement_); }

  int64_t integer(int column) const { return sqlite3_column_int64(statement_, column); }
  /// Of a blob.
  int64_t bytes(int column) const { return sqlite3_column_bytes(statement_, column); }
  double real(int column) const { return sqlite3_column_double(statement_, column); }
  std::string text(int column) const;
  /// The blob in place, valid until the next step.
  std::span<const std::byte> blob(int column) const {
    return {static_cast<const std::byte*>(sqlite3_column_blob(statement_, column)),
            static_cast<size_t>(sqlite3_column_bytes(statement_, column))};
  }
  /// Throws Error if the size of the blob is not a multiple of a float's.
  std::vector<float> floats(int column) const;

 private:
  void check(int code) const;

  const SqliteConnection& connection_;
  sqlite3_stmt* statement_ = nullptr;
};

/// Everything up to commit() is stored together or not at all; inside a running
/// transaction it is a savepoint of it.
class SqliteScope {
 public:
  explicit SqliteScope(const SqliteConnection& connection);
  ~SqliteScope();
  SqliteScope(const SqliteScope&) = delete;
  SqliteScope& operator=(const SqliteScope&) = delete;
  void commit();

 private:
  const SqliteConnection& connection_;
  bool nested_, done_ = false;
};

}  // namespace remomask::db
