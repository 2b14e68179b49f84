#include "db/database.h"

#include <algorithm>

#include "base/error.h"
#include "db/clip_hash.h"
#include "db/schema.h"
#include "db/sqlite.h"

namespace remomask {

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

constexpr const char* kClipColumns =
    "id, name, source, source_file, start_frame, split, licence, content_hash, motion_group, "
    "mirrored, skeleton, frames, labels";

Clip read_clip_row(const SqliteStatement& row, const std::string& path) {
  Clip clip;
  clip.id = row.integer(0);
  clip.name = row.text(1);
  clip.source = row.text(2);
  clip.source_file = row.text(3);
  clip.start_frame = static_cast<int>(row.integer(4));
  clip.split = row.text(5);
  clip.licence = row.text(6);
  clip.content_hash = row.text(7);
  clip.group = row.text(8);
  clip.mirrored = row.integer(9) != 0;
  clip.skeleton = row.text(10);
  clip.frames = static_cast<int>(row.integer(11));
  clip.labels = nlohmann::json::parse(row.text(12), nullptr, false);
  if (clip.labels.is_discarded()) {
    throw Error(path + ": the labels of clip '" + clip.name +
                "' are not JSON: the database is damaged; restore a backup");
  }
  return clip;
}

void check_clip(const Clip& clip, const Motion& motion) {
  if (clip.name.empty()) throw Error("a clip needs a name");
  const std::string subject = "clip '" + clip.name + "': ";
  if (motion.frames < 1 || motion.joints < 1 ||
      motion.positions.size() != static_cast<size_t>(motion.frames) * motion.joints * 3) {
    throw Error(subject + "the motion has no frames, or not three numbers a joint and frame");
  }
  const auto is_split = [&](const char* name) { return clip.split == name; };
  if (!is_split("train") && !is_split("val") && !is_split("test") && !is_split("none")) {
    throw Error(subject + "unknown split '" + clip.split + "'; use train, val, test or none");
  }
  if (!clip.labels.is_object()) throw Error(subject + "labels are not a JSON object");
}

}  // namespace

struct Database::Impl {
  SqliteConnection connection;

  Impl(const std::string& path, OpenMode mode) : connection(path, sqlite_mode(mode)) {
    if (mode == OpenMode::create && is_empty_database(connection)) create_schema(connection);
    check_schema(connection);
    // WAL keeps the file whole at any kill; only a power cut can lose the last
    // commits, and an import repeats those.
    if (mode != OpenMode::read_only) connection.execute("PRAGMA synchronous = NORMAL");
  }

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

void Database::begin() { impl_->connection.execute("BEGIN IMMEDIATE"); }
void Database::commit() { impl_->connection.execute("COMMIT"); }
void Database::rollback() {
  // After some errors SQLite has rolled back on its own.
  if (impl_->connection.in_transaction()) impl_->connection.execute("ROLLBACK");
}

int64_t Database::add_clip(const Clip& clip, const Motion& motion) {
  check_clip(clip, motion);
  const SqliteConnection& connection = impl_->connection;
  const std::string hash =
      clip.content_hash.empty() ? clip_content_hash(motion) : clip.content_hash;
  SqliteScope scope(connection);
  if (find_name(clip.name)) {
    throw Error(path() + ": there is a clip '" + clip.name + "' already; choose another name");
  }
  if (const auto same = find_content(hash)) {
    throw Error(path() + ": clip '" + clip.name + "' is the same motion as the stored clip '" +
                this->clip(*same).name + "'; leave it out");
  }
  SqliteStatement(connection,
                  "INSERT INTO clip (name, source, source_file, start_frame, split, licence, "
                  "content_hash, motion_group, mirrored, skeleton, frames, labels) "
                  "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
      .bind(1, clip.name)
      .bind(2, clip.source)
      .bind(3, clip.source_file)
      .bind(4, clip.start_frame)
      .bind(5, clip.split)
      .bind(6, clip.licence)
      .bind(7, hash)
      .bind(8, clip.group.empty() ? clip.name : clip.group)
      .bind(9, clip.mirrored ? 1 : 0)
      .bind(10, clip.skeleton)
      .bind(11, motion.frames)
      .bind(12, clip.labels.dump())
      .run();
  const int64_t id = connection.last_insert_id();
  SqliteStatement caption(connection, "INSERT INTO caption VALUES (?, ?, ?)");
  for (size_t i = 0; i < clip.captions.size(); ++i) {
    caption.bind(1, id).bind(2, static_cast<int64_t>(i)).bind(3, clip.captions[i]).run();
  }
  SqliteStatement(connection, "INSERT INTO motion VALUES (?, ?, ?, ?)")
      .bind(1, id)
      .bind(2, motion.frames)
      .bind(3, motion.joints)
      .bind(4, motion.positions)
      .run();
  impl_->grow_generation();
  scope.commit();
  return id;
}

int Database::remove_clips(const std::string& source, const std::string& source_file) {
  SqliteScope scope(impl_->connection);
  SqliteStatement(impl_->connection, "DELETE FROM clip WHERE source = ? AND source_file = ?")
      .bind(1, source)
      .bind(2, source_file)
      .run();
  const auto removed = static_cast<int>(impl_->connection.changes());
  SqliteStatement(impl_->connection, "DELETE FROM import_log WHERE source = ? AND file = ?")
      .bind(1, source)
      .bind(2, source_file)
      .run();
  if (removed > 0) impl_->grow_generation();
  scope.commit();
  return removed;
}

std::optional<int64_t> Database::find_name(const std::string& name) const {
  return impl_->find_id("SELECT id FROM clip WHERE name = ?", name);
}

std::optional<int64_t> Database::find_content(const std::string& content_hash) const {
  return impl_->find_id("SELECT id FROM clip WHERE content_hash = ?", content_hash);
}

int64_t Database::clip_count() const {
  return impl_->connection.integer("SELECT count(*) FROM clip");
}

std::vector<Clip> Database::clips() const {
  std::vector<Clip> clips;
  SqliteStatement rows(impl_->connection,
                       (std::string("SELECT ") + kClipColumns + " FROM clip ORDER BY id").c_str());
  while (rows.step()) clips.push_back(read_clip_row(rows, path()));
  SqliteStatement captions(impl_->connection,
                           "SELECT clip_id, text FROM caption ORDER BY clip_id, position");
  auto clip = clips.begin();
  while (captions.step()) {
    const int64_t id = captions.integer(0);
    clip = std::lower_bound(clip, clips.end(), id,
                            [](const Clip& left, int64_t value) { return left.id < value; });
    // A clip that another program added between the two queries.
    if (clip == clips.end()) break;
    if (clip->id == id) clip->captions.push_back(captions.text(1));
  }
  return clips;
}

Clip Database::clip(int64_t id) const {
  SqliteStatement row(impl_->connection,
                      (std::string("SELECT ") + kClipColumns + " FROM clip WHERE id = ?").c_str());
  row.bind(1, id);
  if (!row.step()) throw Error(path() + ": there is no clip number " + std::to_string(id));
  Clip clip = read_clip_row(row, path());
  SqliteStatement captions(impl_->connection,
                           "SELECT text FROM caption WHERE clip_id = ? ORDER BY position");
  captions.bind(1, id);
  while (captions.step()) clip.captions.push_back(captions.text(0));
  return clip;
}

Motion Database::motion(int64_t id) const {
  SqliteStatement row(impl_->connection,
                      "SELECT frames, joints, positions FROM motion WHERE clip_id = ?");
  row.bind(1, id);
  if (!row.step()) throw Error(path() + ": there is no clip number " + std::to_string(id));
  Motion motion;
  motion.frames = static_cast<int>(row.integer(0));
  motion.joints = static_cast<int>(row.integer(1));
  motion.positions = row.floats(2);
  if (motion.frames < 1 || motion.joints < 1 ||
      motion.positions.size() != static_cast<size_t>(motion.frames) * motion.joints * 3) {
    throw Error(path() + ": the motion of clip number " + std::to_string(id) +
                " is cut off: the database is damaged; restore a backup");
  }
  return motion;
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

void Database::store_embeddings(const std::string& retriever_hash,
                                const std::vector<ClipEmbedding>& embeddings) {
  SqliteScope scope(impl_->connection);
  SqliteStatement(impl_->connection, "DELETE FROM embedding WHERE retriever_hash = ?")
      .bind(1, retriever_hash)
      .run();
  SqliteStatement insert(impl_->connection, "INSERT INTO embedding VALUES (?, ?, ?, ?, ?)");
  SqliteStatement known(impl_->connection, "SELECT count(*) FROM clip WHERE id = ?");
  for (const ClipEmbedding& embedding : embeddings) {
    known.bind(1, embedding.clip_id).step();
    if (known.integer(0) == 0) {
      throw Error(path() + ": there is no clip number " + std::to_string(embedding.clip_id) +
                  " to store vectors for; embed the clips of this database again");
    }
    known.reset();
    insert.bind(1, embedding.clip_id)
        .bind(2, retriever_hash)
        .bind(3, embedding.motion)
        .bind(4, embedding.parts)
        .bind(5, embedding.text)
        .run();
  }
  impl_->grow_generation();
  scope.commit();
}

std::vector<ClipEmbedding> Database::embeddings(const std::string& retriever_hash) const {
  std::vector<ClipEmbedding> embeddings;
  SqliteStatement rows(impl_->connection,
                       "SELECT clip_id, motion, parts, text FROM embedding "
                       "WHERE retriever_hash = ? ORDER BY clip_id");
  rows.bind(1, retriever_hash);
  while (rows.step()) {
    embeddings.push_back({rows.integer(0), rows.floats(1), rows.floats(2), rows.floats(3)});
  }
  return embeddings;
}

std::optional<ClipEmbedding> Database::embedding(const std::string& retriever_hash,
                                                 int64_t clip_id) const {
  SqliteStatement row(impl_->connection,
                      "SELECT motion, parts, text FROM embedding "
                      "WHERE clip_id = ? AND retriever_hash = ?");
  row.bind(1, clip_id).bind(2, retriever_hash);
  if (!row.step()) return std::nullopt;
  return ClipEmbedding{clip_id, row.floats(0), row.floats(1), row.floats(2)};
}

void Database::set_fact(const std::string& key, const std::string& value) {
  if (key == "uuid" || key == "generation" || key == "motion_format") {
    throw Error("the fact '" + key + "' belongs to the database itself; choose another key");
  }
  SqliteStatement(impl_->connection, "INSERT OR REPLACE INTO fact VALUES (?, ?)")
      .bind(1, key)
      .bind(2, value)
      .run();
}

std::optional<std::string> Database::fact(const std::string& key) const { return impl_->fact(key); }

}  // namespace remomask
