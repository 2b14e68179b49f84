#include "db/clip_rows.h"

#include <algorithm>
#include <cmath>

#include "base/json.h"
#include "db/checksum.h"
#include "db/schema.h"
#include "remomask/error.h"

namespace remomask::db {

namespace {

constexpr float kFarthestMetres = 1e6f;

std::string select_clips(const SqliteConnection& connection) {
  const bool has_checksum = connection.integer("PRAGMA user_version") >= kChecksumVersion;
  return std::string(
             "SELECT id, name, source, source_file, start_frame, split, licence, content_hash, "
             "motion_group, mirrored, skeleton, frames, labels, speed, ") +
         (has_checksum ? "checksum" : "''") + " FROM clip ";
}

struct ClipRow {
  Clip clip;
  std::string checksum;  // empty: none is stored
};

ClipRow read_clip_row(const SqliteStatement& row, const std::string& path) {
  ClipRow result;
  Clip& clip = result.clip;
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
  clip.speed = row.real(13);
  clip.labels = try_parse_json(row.text(12));
  if (clip.labels.is_discarded()) {
    throw Error(path + ": the labels of clip '" + clip.name +
                "' are no JSON that can be read: the database is damaged; restore a backup");
  }
  result.checksum = row.text(14);
  return result;
}

/// Hands the texts of a query "clip_id, text" that is ordered by clip to the
/// clips, which are ordered as well.
void attach_texts(const SqliteConnection& connection, const char* sql, std::vector<ClipRow>& clips,
                  std::vector<std::string> Clip::*member) {
  SqliteStatement texts(connection, sql);
  auto clip = clips.begin();
  while (texts.step()) {
    const int64_t id = texts.integer(0);
    while (clip != clips.end() && clip->clip.id < id) ++clip;
    if (clip == clips.end()) return;
    if (clip->clip.id == id) (clip->clip.*member).push_back(texts.text(1));
  }
}

std::vector<ClipRow> read_rows(const SqliteConnection& connection) {
  std::vector<ClipRow> clips;
  SqliteStatement rows(connection, (select_clips(connection) + "ORDER BY id").c_str());
  while (rows.step()) clips.push_back(read_clip_row(rows, connection.path()));
  attach_texts(connection, "SELECT clip_id, text FROM caption ORDER BY clip_id, position", clips,
               &Clip::captions);
  attach_texts(connection, "SELECT clip_id, tag FROM tag ORDER BY clip_id, tag", clips,
               &Clip::tags);
  return clips;
}

ClipRow read_row(const SqliteConnection& connection, int64_t id) {
  SqliteStatement row(connection, (select_clips(connection) + "WHERE id = ?").c_str());
  row.bind(1, id);
  if (!row.step()) {
    throw Error(connection.path() + ": there is no clip number " + std::to_string(id));
  }
  ClipRow result = read_clip_row(row, connection.path());
  SqliteStatement captions(connection,
                           "SELECT text FROM caption WHERE clip_id = ? ORDER BY position");
  captions.bind(1, id);
  while (captions.step()) result.clip.captions.push_back(captions.text(0));
  SqliteStatement tags(connection, "SELECT tag FROM tag WHERE clip_id = ? ORDER BY tag");
  tags.bind(1, id);
  while (tags.step()) result.clip.tags.push_back(tags.text(0));
  return result;
}

bool is_damaged(const ClipRow& row) {
  return !row.checksum.empty() && row.checksum != clip_checksum(row.clip);
}

void require_intact(const SqliteConnection& connection, const ClipRow& row) {
  if (!is_damaged(row)) return;
  throw Error(connection.path() + ": what is stored of clip '" + row.clip.name +
              "' (its names, labels, captions or tags) is damaged: its checksum differs; " +
              kReplaceClip);
}

void set_checksum(const SqliteConnection& connection, const ClipRow& row) {
  SqliteStatement(connection, "UPDATE clip SET checksum = ? WHERE id = ?")
      .bind(1, clip_checksum(row.clip))
      .bind(2, row.clip.id)
      .run();
}

}  // namespace

bool all_near(const std::vector<float>& positions) {
  return std::all_of(positions.begin(), positions.end(),
                     [](float value) { return std::abs(value) < kFarthestMetres; });
}

std::vector<Clip> read_clips(const SqliteConnection& connection) {
  std::vector<ClipRow> rows = read_rows(connection);
  std::vector<Clip> clips;
  clips.reserve(rows.size());
  for (ClipRow& row : rows) {
    require_intact(connection, row);
    clips.push_back(std::move(row.clip));
  }
  return clips;
}

Clip read_clip(const SqliteConnection& connection, int64_t id) {
  ClipRow row = read_row(connection, id);
  require_intact(connection, row);
  return std::move(row.clip);
}

std::string clip_damage(const SqliteConnection& connection, int64_t id) {
  if (!is_damaged(read_row(connection, id))) return "";
  return std::string(
             "its names, labels, captions or tags are not those that were stored (their "
             "checksum differs); ") +
         kReplaceClip;
}

void store_clip_checksum(const SqliteConnection& connection, int64_t id) {
  set_checksum(connection, read_row(connection, id));
}

void store_clip_checksums(const SqliteConnection& connection) {
  for (const ClipRow& row : read_rows(connection)) set_checksum(connection, row);
}

}  // namespace remomask::db
