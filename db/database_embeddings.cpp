#include "base/error.h"
#include "db/database.h"
#include "db/database_impl.h"

namespace remomask {

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
                         "INSERT OR REPLACE INTO embedding VALUES (?, ?, ?, ?, ?)");
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

std::vector<ClipEmbedding> Database::embeddings(const std::string& retriever_hash,
                                                const std::vector<int64_t>& ids) const {
  const ReadSnapshot snapshot(*this);
  std::vector<ClipEmbedding> embeddings;
  embeddings.reserve(ids.size());
  SqliteStatement row(impl_->connection,
                      "SELECT motion, parts, text FROM embedding "
                      "WHERE retriever_hash = ? AND clip_id = ?");
  for (const int64_t id : ids) {
    row.bind(1, retriever_hash).bind(2, id);
    if (!row.step()) {
      throw Error(path() + ": clip number " + std::to_string(id) +
                  " has no vectors of this retriever; run: remomask index " + path());
    }
    embeddings.push_back({id, row.floats(0), row.floats(1), row.floats(2)});
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

std::vector<std::string> Database::retrievers() const {
  std::vector<std::string> hashes;
  SqliteStatement rows(impl_->connection,
                       "SELECT DISTINCT retriever_hash FROM embedding ORDER BY retriever_hash");
  while (rows.step()) hashes.push_back(rows.text(0));
  return hashes;
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

}  // namespace remomask
