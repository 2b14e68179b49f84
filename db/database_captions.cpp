#include <span>

#include "db/checksum.h"
#include "db/database.h"
#include "db/database_impl.h"
#include "remomask/error.h"

namespace remomask::db {

std::vector<std::string> Database::captions_without_vector(const std::string& encoder_hash) const {
  const bool some = impl_->has_caption_vectors();
  std::string sql = "SELECT text FROM caption";
  if (impl_->has_guessed_captions()) sql += " UNION SELECT text FROM guessed_caption";
  if (some) sql += " EXCEPT SELECT text FROM caption_vector WHERE encoder_hash = ?";
  SqliteStatement rows(impl_->connection,
                       ("SELECT DISTINCT text FROM (" + sql + ") ORDER BY text").c_str());
  if (some) rows.bind(1, encoder_hash);
  std::vector<std::string> texts;
  while (rows.step()) texts.push_back(rows.text(0));
  return texts;
}

void Database::add_caption_vectors(const std::string& encoder_hash,
                                   const std::vector<CaptionVector>& vectors) {
  if (vectors.empty()) return;
  SqliteScope scope(impl_->connection);
  SqliteStatement insert(impl_->connection,
                         "INSERT OR REPLACE INTO caption_vector VALUES (?, ?, ?, ?)");
  for (const CaptionVector& one : vectors) {
    insert.bind(1, encoder_hash)
        .bind(2, one.text)
        .bind(3, one.vector)
        .bind(4, caption_vector_checksum(one.text, std::as_bytes(std::span(one.vector))))
        .run();
  }
  // Open searches read the vectors again.
  impl_->grow_generation();
  scope.commit();
}

int64_t Database::drop_unused_caption_vectors(const std::string& encoder_hash) {
  SqliteScope scope(impl_->connection);
  SqliteStatement(impl_->connection,
                  "DELETE FROM caption_vector WHERE encoder_hash <> ? OR text NOT IN "
                  "(SELECT text FROM caption UNION SELECT text FROM guessed_caption)")
      .bind(1, encoder_hash)
      .run();
  const int64_t dropped = impl_->connection.integer("SELECT changes()");
  if (dropped > 0) impl_->grow_generation();
  scope.commit();
  return dropped;
}

std::vector<CaptionVector> Database::caption_vectors(const std::string& encoder_hash) const {
  std::vector<CaptionVector> vectors;
  if (!impl_->has_caption_vectors()) return vectors;
  SqliteStatement rows(impl_->connection,
                       "SELECT text, vector, checksum FROM caption_vector WHERE encoder_hash = ? "
                       "ORDER BY text");
  rows.bind(1, encoder_hash);
  while (rows.step()) {
    CaptionVector one{rows.text(0), rows.floats(1)};
    if (rows.text(2) != caption_vector_checksum(one.text, rows.blob(1)) ||
        (!vectors.empty() && vectors.front().vector.size() != one.vector.size())) {
      throw Error(path() + ": the vector of the caption \"" + one.text +
                  "\" is damaged; run: remomask index " + path() + " --rebuild");
    }
    vectors.push_back(std::move(one));
  }
  return vectors;
}

std::vector<std::string> Database::caption_encoders() const {
  std::vector<std::string> hashes;
  if (!impl_->has_caption_vectors()) return hashes;
  SqliteStatement rows(impl_->connection,
                       "SELECT DISTINCT encoder_hash FROM caption_vector ORDER BY encoder_hash");
  while (rows.step()) hashes.push_back(rows.text(0));
  return hashes;
}

}  // namespace remomask::db
