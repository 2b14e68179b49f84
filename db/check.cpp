#include "db/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/json.h"
#include "db/checksum.h"
#include "db/clip_hash.h"
#include "db/clip_rows.h"
#include "db/clip_speed.h"
#include "db/page_checksums.h"
#include "db/schema.h"
#include "db/sqlite.h"
#include "remomask/error.h"

namespace remomask::db {

namespace {

constexpr const char* kRestore = "restore a snapshot";
constexpr double kUnitTolerance = 1e-3;

/// Also false for NaN.
bool all_below(const std::vector<float>& values, float limit) {
  return std::all_of(values.begin(), values.end(),
                     [limit](float value) { return std::abs(value) < limit; });
}

double vector_length(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value) * value;
  return std::sqrt(sum);
}

class Checker {
 public:
  Checker(const SqliteConnection& connection, const Monitor& monitor)
      : connection_(connection), monitor_(monitor) {}

  CheckReport check() && {
    attempt([&] { check_pages(); });
    attempt([&] { check_references(); });
    attempt([&] { check_facts(); });
    attempt([&] { check_clips(); });
    attempt([&] { check_captions(); });
    attempt([&] { check_words(); });
    attempt([&] { check_embeddings(); });
    attempt([&] { check_caption_vectors(); });
    std::stable_sort(
        report_.defects.begin(), report_.defects.end(),
        [](const Defect& left, const Defect& right) { return left.clip_id < right.clip_id; });
    report_.has_checksums = connection_.integer("PRAGMA user_version") >= kPageChecksumVersion;
    return std::move(report_);
  }

 private:
  /// Damaged pages end one part of the check, not all of it.
  template <typename Part>
  void attempt(Part part) {
    try {
      part();
    } catch (const Interrupted&) {
      throw;
    } catch (const Error& error) {
      add(0, error.what());
    }
  }

  void add(int64_t clip_id, const std::string& what) {
    std::string name;
    if (clip_id != 0) {
      const auto known = names_.find(clip_id);
      if (known != names_.end()) name = known->second;
    }
    report_.defects.push_back({clip_id, name, what});
  }

  void check_pages() {
    const std::vector<int64_t> damaged = damaged_pages(connection_.handle());
    for (const int64_t page : damaged) {
      add(0,
          fmt::format("page {} of the file is damaged (its checksum differs); {}", page, kRestore));
    }
    // The rest of the check reads them as they are: it may find out which clips they belong to.
    if (!damaged.empty()) ignore_page_checksums(connection_.handle());
    SqliteStatement rows(connection_, "PRAGMA integrity_check");
    while (rows.step()) {
      if (rows.text(0) != "ok") add(0, "SQLite's check says: " + rows.text(0) + "; " + kRestore);
    }
  }

  void check_references() {
    SqliteStatement rows(connection_, "PRAGMA foreign_key_check");
    while (rows.step()) {
      add(0, fmt::format("row {} of table {} belongs to a clip that is not there; {}",
                         rows.integer(1), rows.text(0), kRestore));
    }
  }

  void check_facts() {
    const int64_t facts = connection_.integer(
        "SELECT count(*) FROM fact WHERE (key = 'uuid' AND length(value) = 36) OR "
        "(key = 'generation' AND CAST(value AS INTEGER) || '' = value)");
    if (facts != 2) add(0, std::string("its uuid or generation is missing; ") + kRestore);
  }

  void check_clips() {
    const int64_t total = connection_.integer("SELECT count(*) FROM clip");
    const std::string sql =
        std::string(
            "SELECT clip.id, name, clip.frames, labels, content_hash, speed, motion.frames, "
            "joints, positions, motion.clip_id IS NULL, ") +
        (checksums_ ? "motion.checksum" : "''") +
        " FROM clip LEFT JOIN motion ON motion.clip_id = clip.id ORDER BY id";
    SqliteStatement rows(connection_, sql.c_str());
    while (rows.step()) {
      if (monitor_.stop_requested()) throw Interrupted("the check was stopped");
      check_clip(rows);
      monitor_.report({"check " + connection_.path(), static_cast<double>(++report_.clips),
                       static_cast<double>(total), "clips"});
    }
  }

  void check_clip(const SqliteStatement& row) {
    const int64_t id = row.integer(0);
    names_[id] = row.text(1);
    const auto labels = try_parse_json(row.text(3));
    const bool sound_labels = labels.is_object();
    if (!sound_labels) add(id, std::string("its labels are no JSON object; ") + kReplaceClip);
    if (row.integer(9) != 0) return add(id, std::string("has no motion; ") + kReplaceClip);
    Motion motion;
    motion.frames = static_cast<int>(row.integer(6));
    motion.joints = static_cast<int>(row.integer(7));
    if (motion.frames != row.integer(2)) {
      return add(id, fmt::format("has {} frames, its motion {}; {}", row.integer(2), motion.frames,
                                 kReplaceClip));
    }
    const int64_t bytes = row.bytes(8);
    if (bytes != static_cast<int64_t>(sizeof(float)) * motion.frames * motion.joints * 3) {
      return add(id, fmt::format("its {} bytes of positions are not {} frames of {} joints; {}",
                                 bytes, motion.frames, motion.joints, kReplaceClip));
    }
    motion.positions = row.floats(8);
    if (!all_near(motion.positions)) {
      return add(id, std::string("a position is no number of metres; ") + kReplaceClip);
    }
    if (clip_content_hash(motion) != row.text(4)) {
      add(id,
          std::string("its motion is not the one that was stored (its content hash differs); ") +
              kReplaceClip);
    } else if (std::abs(mean_root_speed(motion) - row.real(5)) > 1e-6) {
      add(id, std::string("its speed is not that of its motion; ") + kReplaceClip);
    } else if (!row.text(10).empty() &&
               row.text(10) != motion_checksum(row.integer(6), row.integer(7), row.blob(8))) {
      add(id, std::string("its motion is damaged (its checksum differs); ") + kReplaceClip);
    } else if (sound_labels) {
      const std::string damage = clip_damage(connection_, id);
      if (!damage.empty()) add(id, damage);
    }
  }

  void check_captions() {
    report_.captions = connection_.integer("SELECT count(*) FROM caption");
    SqliteStatement rows(connection_,
                         "SELECT clip_id FROM caption GROUP BY clip_id "
                         "HAVING min(position) <> 0 OR max(position) <> count(*) - 1 "
                         "OR max(position) >= 1024");
    while (rows.step()) {
      add(rows.integer(0), std::string("its captions are not numbered from 0; ") + kReplaceClip);
    }
  }

  /// FTS5's own check would write. Instead the captions are indexed anew in a
  /// temporary table, and every place of every word compared.
  void check_words() {
    connection_.execute(R"sql(
      CREATE VIRTUAL TABLE temp.new_words USING fts5 (
        text, content = '', tokenize = 'porter unicode61');
      INSERT INTO temp.new_words (rowid, text) SELECT id, text FROM caption_row;
      CREATE VIRTUAL TABLE temp.new_places USING fts5vocab (temp, new_words, instance);
      CREATE VIRTUAL TABLE temp.old_places USING fts5vocab (main, caption_words, instance);
    )sql");
    // bm25() also asks for the length of every caption.
    SqliteStatement rows(connection_, R"sql(
      SELECT DISTINCT doc / 1024 FROM (
        SELECT doc FROM (SELECT term, doc, offset FROM temp.new_places
                         EXCEPT SELECT term, doc, offset FROM temp.old_places)
        UNION SELECT doc FROM (SELECT term, doc, offset FROM temp.old_places
                               EXCEPT SELECT term, doc, offset FROM temp.new_places)
        UNION SELECT id FROM (SELECT id, sz FROM temp.new_words_docsize
                              EXCEPT SELECT id, sz FROM caption_words_docsize)
        UNION SELECT id FROM (SELECT id, sz FROM caption_words_docsize
                              EXCEPT SELECT id, sz FROM temp.new_words_docsize)
      ) ORDER BY 1)sql");
    while (rows.step()) {
      add(rows.integer(0),
          "the full-text index does not answer for its captions; run: remomask db upgrade DB");
    }
  }

  void check_embeddings() {
    struct Widths {
      int64_t motion, parts;
    };
    std::map<std::string, Widths> widths;
    const std::string sql = std::string("SELECT retriever_hash, clip_id, motion, parts, text, ") +
                            (checksums_ ? "checksum" : "''") +
                            " FROM embedding ORDER BY retriever_hash, clip_id";
    SqliteStatement rows(connection_, sql.c_str());
    while (rows.step()) {
      if (monitor_.stop_requested()) throw Interrupted("the check was stopped");
      ++report_.embeddings;
      const std::string retriever = rows.text(0);
      const int64_t id = rows.integer(1);
      const Widths here{rows.bytes(2), rows.bytes(3)};
      const Widths& first = widths.try_emplace(retriever, here).first->second;
      const bool text_fits = rows.bytes(4) == 0 || rows.bytes(4) == here.motion;
      if (here.motion % 4 != 0 || here.motion != first.motion || here.parts != first.parts ||
          !text_fits) {
        add(id, fmt::format("its vectors of retriever {} are {}, {} and {} bytes, others {} and "
                            "{}; {}",
                            retriever, here.motion, here.parts, rows.bytes(4), first.motion,
                            first.parts, kReplaceClip));
        continue;
      }
      const auto motion = rows.floats(2), parts = rows.floats(3), text = rows.floats(4);
      const bool unit = std::abs(vector_length(motion) - 1) < kUnitTolerance &&
                        (text.empty() || std::abs(vector_length(text) - 1) < kUnitTolerance);
      if (!unit || !all_below(parts, 1 + kUnitTolerance)) {
        add(id, "its vectors of retriever " + retriever + " are not of length 1; " + kReplaceClip);
      } else if (!rows.text(5).empty() &&
                 rows.text(5) != embedding_checksum(rows.blob(2), rows.blob(3), rows.blob(4))) {
        add(id, "its vectors of retriever " + retriever +
                    " are damaged (their checksum differs); run: remomask index DB --rebuild");
      }
    }
  }

  void check_caption_vectors() {
    if (connection_.integer("PRAGMA user_version") < kCaptionVectorVersion) return;
    SqliteStatement rows(connection_,
                         "SELECT encoder_hash, text, vector, checksum FROM caption_vector");
    while (rows.step()) {
      if (rows.text(3) == caption_vector_checksum(rows.text(1), rows.blob(2))) continue;
      add(0, "the vector of the caption \"" + rows.text(1) + "\" made by encoder " + rows.text(0) +
                 " is damaged (its checksum differs); run: remomask index DB --rebuild");
    }
  }

  const SqliteConnection& connection_;
  const Monitor& monitor_;
  const bool checksums_ = connection_.integer("PRAGMA user_version") >= kChecksumVersion;
  CheckReport report_;
  std::map<int64_t, std::string> names_;
};

}  // namespace

CheckReport check_database(const std::string& path, const Monitor& monitor) {
  SqliteConnection connection(path, SqliteMode::read_only);
  connection.stop_when([&] { return monitor.stop_requested(); });
  check_schema(connection);
  require_readable_schema(connection);
  // The check of the words needs temporary tables, which query_only refuses as well.
  connection.execute("PRAGMA query_only = OFF");
  // All parts look at one state, whatever other programs write.
  connection.execute("BEGIN");
  return Checker(connection, monitor).check();
}

}  // namespace remomask::db
