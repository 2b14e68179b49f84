#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "db/checksum.h"
#include "db/database.h"
#include "db/database_impl.h"
#include "remomask/error.h"

namespace remomask::db {

namespace {

Error lacks_vectors(const std::string& path, int64_t id) {
  return Error(
      fmt::format("{}: clip number {} has no vectors of this retriever; "
                  "run: remomask index {}",
                  path, id, path));
}

/// Columns of read_vectors(), of a database with or without checksums.
std::string vector_columns(bool checksums) {
  return std::string("motion, parts, text, ") + (checksums ? "checksum" : "''");
}

/// The vectors of a clip from vector_columns(), which begin at `column`.
ClipEmbedding read_vectors(const SqliteStatement& row, int column, int64_t id,
                           const std::string& path) {
  const std::string checksum = row.text(column + 3);
  if (!checksum.empty() && checksum != embedding_checksum(row.blob(column), row.blob(column + 1),
                                                          row.blob(column + 2))) {
    throw Error(
        fmt::format("{0}: the vectors of clip number {1} are damaged (their checksum "
                    "differs); run: remomask index {0} --rebuild",
                    path, id));
  }
  return {id, row.floats(column), row.floats(column + 1), row.floats(column + 2)};
}

}  // namespace

void Database::store_embeddings(const std::string& retriever_hash,
                                const std::vector<ClipEmbedding>& embeddings) {
  SqliteScope scope(impl_->connection);
  SqliteStatement(impl_->connection, "DELETE FROM embedding WHERE retriever_hash = ?")
      .bind(1, retriever_hash)
      .run();
  add_embeddings(retriever_hash, embeddings);
  scope.commit();
}

void Database::add_embeddings(const std::string& retriever_hash,
                              const std::vector<ClipEmbedding>& embeddings) {
  SqliteScope scope(impl_->connection);
  SqliteStatement insert(impl_->connection,
                         "INSERT OR REPLACE INTO embedding VALUES (?, ?, ?, ?, ?, ?)");
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
        .bind(6, embedding_checksum(std::as_bytes(std::span(embedding.motion)),
                                    std::as_bytes(std::span(embedding.parts)),
                                    std::as_bytes(std::span(embedding.text))))
        .run();
  }
  impl_->grow_generation();
  scope.commit();
}

std::vector<ClipEmbedding> Database::embeddings(const std::string& retriever_hash) const {
  std::vector<ClipEmbedding> embeddings;
  const std::string sql = "SELECT clip_id, " + vector_columns(impl_->has_checksums()) +
                          " FROM embedding WHERE retriever_hash = ? ORDER BY clip_id";
  SqliteStatement rows(impl_->connection, sql.c_str());
  rows.bind(1, retriever_hash);
  while (rows.step()) embeddings.push_back(read_vectors(rows, 1, rows.integer(0), path()));
  return embeddings;
}

std::vector<ClipEmbedding> Database::embeddings(const std::string& retriever_hash,
                                                const std::vector<int64_t>& ids) const {
  const ReadSnapshot snapshot(*this);
  std::vector<ClipEmbedding> embeddings;
  embeddings.reserve(ids.size());
  const std::string sql = "SELECT " + vector_columns(impl_->has_checksums()) +
                          " FROM embedding WHERE retriever_hash = ? AND clip_id = ?";
  SqliteStatement row(impl_->connection, sql.c_str());
  for (const int64_t id : ids) {
    row.bind(1, retriever_hash).bind(2, id);
    if (!row.step()) throw lacks_vectors(path(), id);
    embeddings.push_back(read_vectors(row, 0, id, path()));
    row.reset();
  }
  return embeddings;
}

std::vector<int64_t> Database::embedded_clips(const std::string& retriever_hash) const {
  std::vector<int64_t> ids;
  SqliteStatement rows(impl_->connection, kEmbeddedClips);
  rows.bind(1, retriever_hash);
  while (rows.step()) ids.push_back(rows.integer(0));
  return ids;
}

std::optional<EmbeddingChanges> Database::embedding_changes(const std::string& retriever_hash,
                                                            int64_t generation) const {
  const ReadSnapshot snapshot(*this);
  if (!impl_->logs_changes()) return std::nullopt;
  if (generation < impl_->connection.integer(kChangesSince)) return std::nullopt;
  SqliteStatement rows(impl_->connection, kEmbeddingChanges);
  rows.bind(1, retriever_hash).bind(2, generation);
  std::vector<std::pair<int64_t, bool>> changed;
  while (rows.step()) changed.emplace_back(rows.integer(0), rows.integer(1) != 0);
  // In the log a clip comes once a generation.
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  EmbeddingChanges changes;
  for (const auto& [id, present] : changed) {
    (present ? changes.present : changes.absent).push_back(id);
  }
  return changes;
}

std::vector<float> Database::motion_vectors(const std::string& retriever_hash,
                                            const std::vector<int64_t>& ids, int width) const {
  const ReadSnapshot snapshot(*this);
  const auto numbers = static_cast<size_t>(width);
  std::vector<float> vectors(ids.size() * numbers);
  float* target = vectors.data();
  SqliteStatement row(impl_->connection,
                      "SELECT motion FROM embedding WHERE retriever_hash = ? AND clip_id = ?");
  row.bind(1, retriever_hash);
  for (const int64_t id : ids) {
    row.bind(2, id);
    if (!row.step()) throw lacks_vectors(path(), id);
    const auto stored = row.blob(0);
    if (stored.size() != numbers * sizeof(float) || stored.empty()) {
      throw Error(
          fmt::format("{}: the vector of clip number {} has {} bytes instead of {}; "
                      "store the vectors of this retriever again",
                      path(), id, stored.size(), numbers * sizeof(float)));
    }
    std::memcpy(target, stored.data(), stored.size());
    target += numbers;
    row.reset();
  }
  return vectors;
}

std::vector<std::string> Database::retrievers() const {
  std::vector<std::string> hashes;
  SqliteStatement rows(impl_->connection,
                       "SELECT DISTINCT retriever_hash FROM embedding ORDER BY retriever_hash");
  while (rows.step()) hashes.push_back(rows.text(0));
  return hashes;
}

std::optional<ClipEmbedding> Database::embedding(const std::string& retriever_hash,
                                                 int64_t clip_id) const {
  const std::string sql = "SELECT " + vector_columns(impl_->has_checksums()) +
                          " FROM embedding WHERE clip_id = ? AND retriever_hash = ?";
  SqliteStatement row(impl_->connection, sql.c_str());
  row.bind(1, clip_id).bind(2, retriever_hash);
  if (!row.step()) return std::nullopt;
  return read_vectors(row, 0, clip_id, path());
}

}  // namespace remomask::db
