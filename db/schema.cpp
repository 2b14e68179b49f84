#include "db/schema.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <random>
#include <utility>

#include "db/checksum.h"
#include "db/clip_rows.h"
#include "db/clip_speed.h"
#include "db/database.h"
#include "db/page_checksums.h"
#include "remomask/error.h"

namespace remomask::db {

namespace {

// AUTOINCREMENT: the id of a removed clip never comes back, an index that still
// holds it cannot show another motion under it.
constexpr const char* kVersion1 = R"sql(
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

// A new file takes the same steps as an old one, so that both end alike. The
// view gives captions the row numbers of the full-text index, kCaptionsOfClip a
// clip; the index keeps no second copy of the texts.
constexpr const char* kVersion2 = R"sql(
ALTER TABLE clip ADD COLUMN speed REAL NOT NULL DEFAULT 0;

CREATE TABLE tag (
  clip_id INTEGER NOT NULL REFERENCES clip (id) ON DELETE CASCADE,
  tag TEXT NOT NULL,
  PRIMARY KEY (clip_id, tag)
) WITHOUT ROWID;

CREATE INDEX embedding_by_retriever ON embedding (retriever_hash, clip_id);

CREATE VIEW caption_row AS
  SELECT clip_id * 1024 + position AS id, text FROM caption;

CREATE VIRTUAL TABLE caption_words USING fts5 (
  text, content = 'caption_row', content_rowid = 'id', tokenize = 'porter unicode61'
);

CREATE TRIGGER caption_inserted AFTER INSERT ON caption BEGIN
  INSERT INTO caption_words (rowid, text) VALUES (new.clip_id * 1024 + new.position, new.text);
END;
CREATE TRIGGER caption_deleted AFTER DELETE ON caption BEGIN
  INSERT INTO caption_words (caption_words, rowid, text)
    VALUES ('delete', old.clip_id * 1024 + old.position, old.text);
END;
CREATE TRIGGER caption_updated AFTER UPDATE ON caption BEGIN
  INSERT INTO caption_words (caption_words, rowid, text)
    VALUES ('delete', old.clip_id * 1024 + old.position, old.text);
  INSERT INTO caption_words (rowid, text) VALUES (new.clip_id * 1024 + new.position, new.text);
END;
)sql";
static_assert(kCaptionsOfClip == 1024, "the schema says 1024");

// Triggers also see what deleting a clip takes with it. A change belongs to the
// generation that its transaction is about to make.
constexpr const char* kVersion3 = R"sql(
CREATE TABLE embedding_change (
  retriever_hash TEXT NOT NULL,
  generation INTEGER NOT NULL,
  clip_id INTEGER NOT NULL,
  PRIMARY KEY (retriever_hash, generation, clip_id)
) WITHOUT ROWID;

CREATE TRIGGER embedding_inserted AFTER INSERT ON embedding BEGIN
  INSERT OR IGNORE INTO embedding_change
    SELECT new.retriever_hash, CAST(value AS INTEGER) + 1, new.clip_id
    FROM fact WHERE key = 'generation';
END;
CREATE TRIGGER embedding_deleted AFTER DELETE ON embedding BEGIN
  INSERT OR IGNORE INTO embedding_change
    SELECT old.retriever_hash, CAST(value AS INTEGER) + 1, old.clip_id
    FROM fact WHERE key = 'generation';
END;

CREATE TABLE writer (
  generation INTEGER PRIMARY KEY,
  token TEXT NOT NULL
);

INSERT INTO fact SELECT 'changes_since', value FROM fact WHERE key = 'generation';
)sql";

constexpr const char* kVersion4 = R"sql(
ALTER TABLE clip ADD COLUMN checksum TEXT NOT NULL DEFAULT '';
ALTER TABLE motion ADD COLUMN checksum TEXT NOT NULL DEFAULT '';
ALTER TABLE embedding ADD COLUMN checksum TEXT NOT NULL DEFAULT '';
)sql";

// By text and not by clip: many clips share captions, and a caption that comes back needs no new
// vector.
constexpr const char* kVersion5 = R"sql(
CREATE TABLE caption_vector (
  encoder_hash TEXT NOT NULL,
  text TEXT NOT NULL,
  vector BLOB NOT NULL,
  checksum TEXT NOT NULL,
  PRIMARY KEY (encoder_hash, text)
);
)sql";

// What people say of a clip takes the place of what was guessed.
constexpr const char* kVersion6 = R"sql(
CREATE TABLE guessed_caption (
  clip_id INTEGER NOT NULL REFERENCES clip (id) ON DELETE CASCADE,
  position INTEGER NOT NULL,
  text TEXT NOT NULL,
  probability REAL NOT NULL,
  PRIMARY KEY (clip_id, position)
) WITHOUT ROWID;

CREATE TRIGGER caption_replaces_guess AFTER INSERT ON caption BEGIN
  DELETE FROM guessed_caption WHERE clip_id = new.clip_id;
END;
)sql";

constexpr const char* kVersions[] = {kVersion1, kVersion2, kVersion3,
                                     kVersion4, kVersion5, kVersion6};
static_assert(std::size(kVersions) == kUnsealedVersion);

void set_version(const SqliteConnection& connection, int64_t version) {
  connection.execute(("PRAGMA user_version = " + std::to_string(version)).c_str());
}

void fill_speeds(const SqliteConnection& connection) {
  SqliteStatement rows(connection, "SELECT clip_id, frames, joints, positions FROM motion");
  SqliteStatement update(connection, "UPDATE clip SET speed = ? WHERE id = ?");
  while (rows.step()) {
    Motion motion;
    motion.frames = static_cast<int>(rows.integer(1));
    motion.joints = static_cast<int>(rows.integer(2));
    motion.positions = rows.floats(3);
    if (!is_whole_motion(motion)) {
      throw Error(connection.path() + ": the motion of clip number " +
                  std::to_string(rows.integer(0)) +
                  " is cut off: the database is damaged; restore a backup");
    }
    update.bind_real(1, mean_root_speed(motion)).bind(2, rows.integer(0)).run();
  }
}

void upgrade_from_1(const SqliteConnection& connection) {
  const int64_t most = connection.integer("SELECT coalesce(max(position), 0) FROM caption");
  if (most >= kCaptionsOfClip) {
    throw Error(connection.path() + ": a clip has more than " + std::to_string(kCaptionsOfClip) +
                " captions, which format 2 cannot hold; delete some with the version that made it");
  }
  connection.execute(kVersion2);
  connection.execute("INSERT INTO caption_words (caption_words) VALUES ('rebuild')");
  fill_speeds(connection);
  set_version(connection, 2);
}

void upgrade_from_2(const SqliteConnection& connection) {
  connection.execute(kVersion3);
  set_version(connection, 3);
}

void fill_checksums(const SqliteConnection& connection) {
  SqliteStatement motions(connection, "SELECT clip_id, frames, joints, positions FROM motion");
  SqliteStatement motion(connection, "UPDATE motion SET checksum = ? WHERE clip_id = ?");
  while (motions.step()) {
    motion.bind(1, motion_checksum(motions.integer(1), motions.integer(2), motions.blob(3)))
        .bind(2, motions.integer(0))
        .run();
  }
  SqliteStatement rows(connection,
                       "SELECT clip_id, retriever_hash, motion, parts, text FROM embedding");
  SqliteStatement embedding(
      connection, "UPDATE embedding SET checksum = ? WHERE clip_id = ? AND retriever_hash = ?");
  while (rows.step()) {
    embedding.bind(1, embedding_checksum(rows.blob(2), rows.blob(3), rows.blob(4)))
        .bind(2, rows.integer(0))
        .bind(3, rows.text(1))
        .run();
  }
  store_clip_checksums(connection);
}

void upgrade_from_3(const SqliteConnection& connection) {
  connection.execute(kVersion4);
  fill_checksums(connection);
  set_version(connection, 4);
}

void upgrade_from_4(const SqliteConnection& connection) {
  connection.execute(kVersion5);
  set_version(connection, 5);
}

void upgrade_from_5(const SqliteConnection& connection) {
  connection.execute(kVersion6);
  set_version(connection, 6);
}

using SchemaObjects = std::map<std::pair<std::string, std::string>, std::string>;

std::string without_blanks(std::string text) {
  text.erase(std::remove_if(text.begin(), text.end(),
                            [](char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }),
             text.end());
  return text;
}

/// What a database holds by type and name, with the statement that made it. The tables behind the
/// full-text index are SQLite's own: their statements differ between its versions.
SchemaObjects schema_objects(const SqliteConnection& connection) {
  SchemaObjects objects;
  SqliteStatement rows(connection,
                       "SELECT type, name, sql FROM sqlite_master WHERE name NOT LIKE 'sqlite\\_%' "
                       "ESCAPE '\\'");
  while (rows.step()) {
    const std::string name = rows.text(1);
    const bool shadow = name.starts_with("caption_words_");
    objects[{rows.text(0), name}] = shadow ? "" : without_blanks(rows.text(2));
  }
  return objects;
}

/// What a database of a version holds.
const SchemaObjects& expected_objects(int64_t version) {
  static std::mutex mutex;
  static std::map<int64_t, SchemaObjects> known;
  const std::scoped_lock lock(mutex);
  const auto found = known.find(version);
  if (found != known.end()) return found->second;
  const SqliteConnection memory(":memory:", SqliteMode::create);
  for (int64_t i = 0; i < std::min(version, kUnsealedVersion); ++i) memory.execute(kVersions[i]);
  return known.emplace(version, schema_objects(memory)).first->second;
}

void require_own_objects(const SqliteConnection& connection, int64_t version) {
  const SchemaObjects& expected = expected_objects(version);
  const SchemaObjects found = schema_objects(connection);
  for (const auto& [object, sql] : found) {
    const auto& [type, name] = object;
    const auto own = expected.find(object);
    if (own == expected.end()) {
      throw Error(connection.path() + ": holds the " + type + " '" + name +
                  "', which remomask did not make and which could run statements of its own; "
                  "if you trust the file, remove it with the sqlite3 program: DROP " +
                  type + " " + name + ", then run: remomask db upgrade " + connection.path() +
                  " --accept-changes");
    }
    if (own->second != sql) {
      throw Error(connection.path() + ": the " + type + " '" + name +
                  "' is not the one that remomask makes: the database is damaged or was changed "
                  "by another program; restore a backup");
    }
  }
  for (const auto& [object, sql] : expected) {
    if (found.contains(object)) continue;
    throw Error(connection.path() + ": the " + object.first + " '" + object.second +
                "' is missing: the database is damaged; restore a backup");
  }
}

}  // namespace

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

bool is_empty_database(const SqliteConnection& connection) {
  return connection.integer("SELECT count(*) FROM sqlite_master") == 0 &&
         connection.integer("PRAGMA application_id") == 0;
}

void create_schema(const SqliteConnection& connection) {
  reserve_page_checksums(connection.handle());
  connection.execute("PRAGMA journal_mode = WAL");
  SqliteScope scope(connection);
  // Another program may have made it between our look and our lock.
  if (!is_empty_database(connection)) return;
  for (const char* version : kVersions) connection.execute(version);
  SqliteStatement(connection, "INSERT INTO fact VALUES ('uuid', ?)").bind(1, random_uuid()).run();
  connection.execute(("PRAGMA application_id = " + std::to_string(kApplicationId)).c_str());
  set_version(connection, kSchemaVersion);
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
  if (version >= kPageChecksumVersion && !has_page_checksums(connection.handle())) {
    throw Error(path + ": its first page is damaged (it denies the checksums of this format); " +
                "restore a backup");
  }
  require_own_objects(connection, version);
  connection.trust_schema();
}

void upgrade_schema(const SqliteConnection& connection) {
  if (connection.integer("PRAGMA user_version") >= kUnsealedVersion) return;
  SqliteScope scope(connection);
  // Another program may have done it between our look and our lock.
  if (connection.integer("PRAGMA user_version") == 1) upgrade_from_1(connection);
  if (connection.integer("PRAGMA user_version") == 2) upgrade_from_2(connection);
  if (connection.integer("PRAGMA user_version") == 3) upgrade_from_3(connection);
  if (connection.integer("PRAGMA user_version") == 4) upgrade_from_4(connection);
  if (connection.integer("PRAGMA user_version") == 5) upgrade_from_5(connection);
  scope.commit();
}

void seal_pages(const SqliteConnection& connection) {
  // A rollback journal would be played back without room for checksums onto pages that have it.
  connection.execute("PRAGMA journal_mode = WAL");
  reserve_page_checksums(connection.handle());
  connection.execute("VACUUM");
  // In WAL mode the file itself changes, and shrinks, at a checkpoint.
  connection.execute("PRAGMA wal_checkpoint(TRUNCATE)");
  if (has_page_checksums(connection.handle())) set_version(connection, kSchemaVersion);
}

void renew_identity(const SqliteConnection& connection) {
  SqliteStatement(connection, "UPDATE fact SET value = ? WHERE key = 'uuid'")
      .bind(1, random_uuid())
      .run();
}

void require_readable_schema(const SqliteConnection& connection) {
  const int64_t version = connection.integer("PRAGMA user_version");
  if (version >= kOldestReadableVersion) return;
  throw Error(connection.path() + ": was made by an older version of remomask (format " +
              std::to_string(version) + "); run: remomask db upgrade " + connection.path());
}

}  // namespace remomask::db
