#include <fmt/format.h>

#include "db/database.h"
#include "db/database_impl.h"
#include "remomask/error.h"

namespace remomask::db {

std::vector<GuessedCaption> Database::guessed_captions() const {
  std::vector<GuessedCaption> guesses;
  if (!impl_->has_guessed_captions()) return guesses;
  SqliteStatement rows(impl_->connection,
                       "SELECT clip_id, text, probability FROM guessed_caption "
                       "ORDER BY clip_id, position");
  while (rows.step()) guesses.push_back({rows.integer(0), rows.text(1), rows.real(2)});
  return guesses;
}

void Database::store_guesses(const std::vector<GuessedCaption>& guesses) {
  if (guesses.empty()) return;
  SqliteScope scope(impl_->connection);
  SqliteStatement described(impl_->connection,
                            "SELECT EXISTS (SELECT 1 FROM caption WHERE clip_id = ?)");
  SqliteStatement next(impl_->connection,
                       "SELECT coalesce(max(position) + 1, 0) FROM guessed_caption "
                       "WHERE clip_id = ?");
  SqliteStatement insert(impl_->connection, "INSERT INTO guessed_caption VALUES (?, ?, ?, ?)");
  for (const GuessedCaption& guess : guesses) {
    described.bind(1, guess.clip_id).step();
    const bool has_captions = described.integer(0) != 0;
    described.reset();
    if (has_captions || guess.text.empty() || !(guess.probability > 0 && guess.probability < 1)) {
      throw Error(fmt::format(
          "{}: a guessed caption of clip number {} is refused: it needs a text, a probability "
          "between 0 and 1, and a clip that nobody has described",
          path(), guess.clip_id));
    }
    next.bind(1, guess.clip_id).step();
    const int64_t position = next.integer(0);
    next.reset();
    insert.bind(1, guess.clip_id).bind(2, position).bind(3, guess.text);
    insert.bind_real(4, guess.probability).run();
  }
  impl_->grow_generation();
  scope.commit();
}

int64_t Database::remove_guesses(const std::vector<int64_t>& clip_ids) {
  SqliteScope scope(impl_->connection);
  SqliteStatement remove(impl_->connection, "DELETE FROM guessed_caption WHERE clip_id = ?");
  int64_t clips = 0;
  for (const int64_t id : clip_ids) {
    remove.bind(1, id).run();
    if (impl_->connection.changes() > 0) ++clips;
  }
  if (clips > 0) impl_->grow_generation();
  scope.commit();
  return clips;
}

}  // namespace remomask::db
