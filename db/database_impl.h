#pragma once

#include "base/error.h"
#include "db/database.h"
#include "db/sqlite.h"

namespace remomask {

/// Answered by an index alone (the tests ask SQLite for its plan): rows of
/// `embedding` are several kilobytes each.
constexpr const char* kEmbeddedClips =
    "SELECT clip_id FROM embedding WHERE retriever_hash = ? ORDER BY clip_id";

struct Database::Impl {
  SqliteConnection connection;

  Impl(const std::string& path, OpenMode mode);

  std::optional<int64_t> find_id(const char* sql, const std::string& value) const {
    SqliteStatement statement(connection, sql);
    statement.bind(1, value);
    if (!statement.step()) return std::nullopt;
    return statement.integer(0);
  }

  void grow_generation() {
    connection.execute(
        "UPDATE fact SET value = CAST(value AS INTEGER) + 1 WHERE key = 'generation'");
  }

  std::optional<std::string> fact(const std::string& key) const {
    SqliteStatement statement(connection, "SELECT value FROM fact WHERE key = ?");
    statement.bind(1, key);
    if (!statement.step()) return std::nullopt;
    return statement.text(0);
  }

  std::string required_fact(const std::string& key) const {
    const auto value = fact(key);
    if (!value) {
      throw Error(connection.path() + ": has no '" + key +
                  "': the database is damaged; restore a backup");
    }
    return *value;
  }
};

}  // namespace remomask
