#include "db/schema.h"

#include <random>

#include "base/error.h"

namespace remomask {

namespace {

// AUTOINCREMENT: the id of a removed clip never comes back, an index that still
// holds it cannot show another motion under it.
constexpr const char* kSchema = R"sql(
CREATE TABLE fact (
  key TEXT PRIMARY KEY,
  value TEXT NOT NULL
) WITHOUT ROWID;

CREATE TABLE clip (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  name TEXT NOT NULL UNIQUE,
  source TEXT NOT NULL,
  source_file TEXT NOT NULL,
  start_frame INTEGER NOT NULL,
  split TEXT NOT NULL CHECK (split IN ('train', 'val', 'test', 'none')),
  licence TEXT NOT NULL,
  content_hash TEXT NOT NULL UNIQUE,
  motion_group TEXT NOT NULL,
  mirrored INTEGER NOT NULL CHECK (mirrored IN (0, 1)),
  skeleton TEXT NOT NULL,
  frames INTEGER NOT NULL CHECK (frames > 0),
  labels TEXT NOT NULL
);
CREATE INDEX clip_by_file ON clip (source, source_file);

CREATE TABLE caption (
  clip_id INTEGER NOT NULL REFERENCES clip (id) ON DELETE CASCADE,
  position INTEGER NOT NULL,
  text TEXT NOT NULL,
  PRIMARY KEY (clip_id, position)
) WITHOUT ROWID;

CREATE TABLE motion (
  clip_id INTEGER PRIMARY KEY REFERENCES clip (id) ON DELETE CASCADE,
  frames INTEGER NOT NULL,
  joints INTEGER NOT NULL,
  positions BLOB NOT NULL
);

CREATE TABLE embedding (
  clip_id INTEGER NOT NULL REFERENCES clip (id) ON DELETE CASCADE,
  retriever_hash TEXT NOT NULL,
  motion BLOB NOT NULL,
  parts BLOB NOT NULL,
  text BLOB NOT NULL,
  PRIMARY KEY (clip_id, retriever_hash)
);

CREATE TABLE import_log (
  source TEXT NOT NULL,
  file TEXT NOT NULL,
  fingerprint TEXT NOT NULL,
  outcome TEXT NOT NULL,
  PRIMARY KEY (source, file)
) WITHOUT ROWID;

INSERT INTO fact VALUES ('generation', '0'), ('motion_format', 'float32 [frames][joints][3]');
)sql";

std::string random_uuid() {
  std::random_device device;
  constexpr char kDigits[] = "0123456789abcdef";
  std::string uuid;
  for (int i = 0; i < 32; ++i) {
    if (i == 8 || i == 12 || i == 16 || i == 20) uuid += '-';
    // Version 4, variant 1 of RFC 4122.
    const unsigned bits = device() & 15u;
    uuid += i == 12 ? '4' : kDigits[i == 16 ? (bits & 3u) | 8u : bits];
  }
  return uuid;
}

}  // namespace

bool is_empty_database(const SqliteConnection& connection) {
  return connection.integer("SELECT count(*) FROM sqlite_master") == 0 &&
         connection.integer("PRAGMA application_id") == 0;
}

void create_schema(const SqliteConnection& connection) {
  connection.execute("PRAGMA journal_mode = WAL");
  SqliteScope scope(connection);
  // Another program may have made it between our look and our lock.
  if (!is_empty_database(connection)) return;
  connection.execute(kSchema);
  SqliteStatement(connection, "INSERT INTO fact VALUES ('uuid', ?)").bind(1, random_uuid()).run();
  connection.execute(("PRAGMA application_id = " + std::to_string(kApplicationId)).c_str());
  connection.execute(("PRAGMA user_version = " + std::to_string(kSchemaVersion)).c_str());
  scope.commit();
}

void check_schema(const SqliteConnection& connection) {
  const std::string& path = connection.path();
  if (connection.integer("PRAGMA application_id") != kApplicationId) {
    throw Error(path + ": is not a motion database (it is empty or belongs to another program); " +
                "check the path");
  }
  const int64_t version = connection.integer("PRAGMA user_version");
  if (version > kSchemaVersion) {
    throw Error(path + ": was made by a newer version of remomask (format " +
                std::to_string(version) + ", this program reads up to " +
                std::to_string(kSchemaVersion) + "); use that version, or import again");
  }
  if (version < 1) {
    throw Error(path + ": has no format version: the database is damaged; restore a backup");
  }
}

}  // namespace remomask
