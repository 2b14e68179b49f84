#pragma once

#include <sys/types.h>

#include <utility>

#include "db/database.h"
#include "db/schema.h"
#include "db/sqlite.h"
#include "remomask/error.h"

namespace remomask::db {

/// Answered by an index alone (the tests ask SQLite for its plan): rows of
/// `embedding` are several kilobytes each.
constexpr const char* kEmbeddedClips =
    "SELECT clip_id FROM embedding WHERE retriever_hash = ? ORDER BY clip_id";

/// Of one retriever, after one generation; answered by indexes alone as well.
constexpr const char* kEmbeddingChanges =
    "SELECT clip_id, EXISTS (SELECT 1 FROM embedding WHERE embedding.retriever_hash = ?1 AND "
    "embedding.clip_id = embedding_change.clip_id) "
    "FROM embedding_change WHERE retriever_hash = ?1 AND generation > ?2";
constexpr const char* kChangesSince =
    "SELECT CAST(value AS INTEGER) FROM fact WHERE key = 'changes_since'";

struct Database::Impl {
  SqliteConnection connection;
  const std::string token = random_uuid();  ///< signs what is written through this object

  const std::pair<dev_t, ino_t> file;  ///< that was opened

  Impl(const std::string& path, OpenMode mode);

  /// Throws Error if another file, or none, lies at the path by now: SQLite goes on writing into
  /// the one that was removed.
  void require_same_file() const;

  std::optional<int64_t> find_id(const char* sql, const std::string& value) const {
    SqliteStatement statement(connection, sql);
    statement.bind(1, value);
    if (!statement.step()) return std::nullopt;
    return statement.integer(0);
  }

  void grow_generation() {
    connection.execute(
        "UPDATE fact SET value = CAST(value AS INTEGER) + 1 WHERE key = 'generation'");
    SqliteStatement(connection,
                    "INSERT INTO writer SELECT CAST(value AS INTEGER), ?1 FROM fact "
                    "WHERE key = 'generation' AND "
                    "(SELECT token FROM writer ORDER BY generation DESC LIMIT 1) IS NOT ?1")
        .bind(1, token)
        .run();
  }

  /// Asked each time: another program may upgrade the file.
  bool logs_changes() const { return connection.integer("PRAGMA user_version") >= kLoggingVersion; }

  bool has_checksums() const {
    return connection.integer("PRAGMA user_version") >= kChecksumVersion;
  }

  bool has_caption_vectors() const {
    return connection.integer("PRAGMA user_version") >= kCaptionVectorVersion;
  }

  bool has_guessed_captions() const {
    return connection.integer("PRAGMA user_version") >= kGuessedCaptionVersion;
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

}  // namespace remomask::db
