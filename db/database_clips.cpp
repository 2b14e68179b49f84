#include <algorithm>

#include "db/checksum.h"
#include "db/clip_hash.h"
#include "db/clip_rows.h"
#include "db/clip_speed.h"
#include "db/database.h"
#include "db/database_impl.h"
#include "remomask/error.h"

namespace remomask::db {

namespace {

void check_split(const std::string& split, const std::string& subject) {
  if (split != "train" && split != "val" && split != "test" && split != "none") {
    throw Error(subject + "unknown split '" + split + "'; use train, val, test or none");
  }
}

void check_captions(const std::vector<std::string>& captions, const std::string& subject) {
  if (captions.size() > static_cast<size_t>(kCaptionsOfClip)) {
    throw Error(subject + "has " + std::to_string(captions.size()) + " captions, at most " +
                std::to_string(kCaptionsOfClip) + " can be stored; leave some out");
  }
}

void check_tags(const std::vector<std::string>& tags, const std::string& subject) {
  for (const std::string& tag : tags) {
    const bool bare = !tag.empty() && tag.front() != ' ' && tag.back() != ' ';
    const bool printable = std::none_of(tag.begin(), tag.end(),
                                        [](char c) { return static_cast<unsigned char>(c) < ' '; });
    if (!bare || !printable) {
      throw Error(
          subject + "'" + tag +
          "' is not a tag; use one or more words without line breaks or surrounding spaces");
    }
  }
}

void check_clip(const Clip& clip, const Motion& motion) {
  if (clip.name.empty()) throw Error("a clip needs a name");
  const std::string subject = "clip '" + clip.name + "': ";
  if (!is_whole_motion(motion)) {
    throw Error(subject + "the motion has no frames, or not three numbers a joint and frame");
  }
  check_split(clip.split, subject);
  check_captions(clip.captions, subject);
  check_tags(clip.tags, subject);
  if (!clip.labels.is_object()) throw Error(subject + "labels are not a JSON object");
}

void insert_captions(const SqliteConnection& connection, int64_t id,
                     const std::vector<std::string>& captions) {
  SqliteStatement insert(connection, "INSERT INTO caption VALUES (?, ?, ?)");
  for (size_t i = 0; i < captions.size(); ++i) {
    insert.bind(1, id).bind(2, static_cast<int64_t>(i)).bind(3, captions[i]).run();
  }
}

void insert_tags(const SqliteConnection& connection, int64_t id,
                 const std::vector<std::string>& tags) {
  SqliteStatement insert(connection, "INSERT OR IGNORE INTO tag VALUES (?, ?)");
  for (const std::string& tag : tags) insert.bind(1, id).bind(2, tag).run();
}

std::vector<std::string> sorted_tags(std::vector<std::string> tags) {
  std::sort(tags.begin(), tags.end());
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  return tags;
}

void delete_of_clip(const SqliteConnection& connection, const char* table, int64_t id) {
  const std::string sql = std::string("DELETE FROM ") + table + " WHERE clip_id = ?";
  SqliteStatement(connection, sql.c_str()).bind(1, id).run();
}

void set_column(const SqliteConnection& connection, const char* column, int64_t id,
                const std::string& value) {
  const std::string sql = std::string("UPDATE clip SET ") + column + " = ? WHERE id = ?";
  SqliteStatement(connection, sql.c_str()).bind(1, value).bind(2, id).run();
}

}  // namespace

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
                  "content_hash, motion_group, mirrored, skeleton, frames, labels, speed) "
                  "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
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
      .bind_real(13, mean_root_speed(motion))
      .run();
  const int64_t id = connection.last_insert_id();
  insert_captions(connection, id, clip.captions);
  insert_tags(connection, id, clip.tags);
  SqliteStatement(connection, "INSERT INTO motion VALUES (?, ?, ?, ?, ?)")
      .bind(1, id)
      .bind(2, motion.frames)
      .bind(3, motion.joints)
      .bind(4, motion.positions)
      .bind(5, motion_checksum(motion.frames, motion.joints,
                               std::as_bytes(std::span(motion.positions))))
      .run();
  store_clip_checksum(connection, id);
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

bool Database::update_clip(int64_t id, const ClipChanges& changes) {
  const SqliteConnection& connection = impl_->connection;
  SqliteScope scope(connection);
  const Clip before = clip(id);
  const std::string subject = path() + ": clip '" + before.name + "': ";
  bool changed = false;
  if (changes.captions && *changes.captions != before.captions) {
    check_captions(*changes.captions, subject);
    delete_of_clip(connection, "caption", id);
    insert_captions(connection, id, *changes.captions);
    // Their text vectors are of the old captions.
    delete_of_clip(connection, "embedding", id);
    changed = true;
  }
  if (changes.labels) {
    if (!changes.labels->is_object()) throw Error(subject + "labels are not a JSON object");
    nlohmann::json labels = before.labels;
    labels.merge_patch(*changes.labels);
    if (labels != before.labels) {
      set_column(connection, "labels", id, labels.dump());
      changed = true;
    }
  }
  if (changes.licence && *changes.licence != before.licence) {
    set_column(connection, "licence", id, *changes.licence);
    changed = true;
  }
  if (changes.split && *changes.split != before.split) {
    check_split(*changes.split, subject);
    set_column(connection, "split", id, *changes.split);
    changed = true;
  }
  if (changes.tags && sorted_tags(*changes.tags) != before.tags) {
    check_tags(*changes.tags, subject);
    delete_of_clip(connection, "tag", id);
    insert_tags(connection, id, *changes.tags);
    changed = true;
  }
  if (changed) {
    store_clip_checksum(connection, id);
    impl_->grow_generation();
  }
  scope.commit();
  return changed;
}

void Database::remove(const std::vector<int64_t>& ids) {
  SqliteScope scope(impl_->connection);
  SqliteStatement statement(impl_->connection, "DELETE FROM clip WHERE id = ?");
  for (const int64_t id : ids) {
    statement.bind(1, id).run();
    if (impl_->connection.changes() != 1) {
      throw Error(path() + ": there is no clip number " + std::to_string(id));
    }
  }
  if (!ids.empty()) impl_->grow_generation();
  scope.commit();
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
  const ReadSnapshot snapshot(*this);
  return read_clips(impl_->connection);
}

Clip Database::clip(int64_t id) const {
  const ReadSnapshot snapshot(*this);
  return read_clip(impl_->connection, id);
}

Motion Database::motion(int64_t id) const {
  const std::string sql = std::string("SELECT motion.frames, joints, positions, skeleton, name, ") +
                          (impl_->has_checksums() ? "motion.checksum" : "''") +
                          " FROM motion JOIN clip ON clip.id = clip_id WHERE clip_id = ?";
  SqliteStatement row(impl_->connection, sql.c_str());
  row.bind(1, id);
  if (!row.step()) throw Error(path() + ": there is no clip number " + std::to_string(id));
  const std::string subject = path() + ": the motion of clip '" + row.text(4) + "' ";
  const std::string checksum = row.text(5);
  if (!checksum.empty() &&
      checksum != motion_checksum(row.integer(0), row.integer(1), row.blob(2))) {
    throw Error(subject + "is damaged (its checksum differs); " + kReplaceClip);
  }
  Motion motion;
  motion.frames = static_cast<int>(row.integer(0));
  motion.joints = static_cast<int>(row.integer(1));
  motion.positions = row.floats(2);
  motion.skeleton = row.text(3);
  motion.fps = skeleton_named(motion.skeleton).fps;
  if (!is_whole_motion(motion)) throw Error(subject + "is cut off; " + kReplaceClip);
  if (!all_near(motion.positions)) {
    throw Error(subject + "holds a value that is no position in metres; " + kReplaceClip);
  }
  return motion;
}

}  // namespace remomask::db
