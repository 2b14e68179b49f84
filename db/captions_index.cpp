#include "db/captions_index.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>
#include <unordered_set>

#include "db/database.h"
#include "db/database_impl.h"
#include "remomask/error.h"

namespace remomask::db {

namespace {

/// Bytes above 127 belong to letters of other scripts.
bool has_letter(const std::string& word) {
  return std::any_of(word.begin(), word.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte > 127 || std::isalnum(byte) != 0;
  });
}

/// FTS5 says near which word it stopped: where that is in the query.
std::string error_place(const std::string& query, const std::string& message) {
  constexpr std::string_view kNear = "near \"";
  const size_t start = message.find(kNear);
  if (start == std::string::npos) return "";
  const size_t word = start + kNear.size();
  const std::string near = message.substr(word, message.rfind('"') - word);
  const size_t place = near.empty() ? query.size() : query.find(near);
  return place == std::string::npos ? "" : " at character " + std::to_string(place + 1);
}

}  // namespace

std::string quote_caption_words(const std::string& text) {
  std::string without_zeros = text;  // which would end the query
  std::replace(without_zeros.begin(), without_zeros.end(), '\0', ' ');
  std::istringstream words(without_zeros);
  std::string query;
  for (std::string word; words >> word;) {
    if (!has_letter(word)) continue;
    query += query.empty() ? "\"" : " \"";
    for (const char c : word) query += c == '"' ? "\"\"" : std::string(1, c);
    query += '"';
  }
  return query;
}

std::vector<int64_t> Database::clips_with_words(const std::string& fts_query) const {
  SqliteStatement rows(
      impl_->connection,
      "SELECT rowid FROM caption_words WHERE caption_words MATCH ? ORDER BY rowid");
  rows.bind(1, fts_query);
  std::vector<int64_t> ids;
  while (rows.step()) {
    const int64_t id = rows.integer(0) / kCaptionsOfClip;
    if (ids.empty() || ids.back() != id) ids.push_back(id);
  }
  return ids;
}

bool Database::clip_has_words(int64_t clip_id, const std::string& fts_query) const {
  SqliteStatement row(impl_->connection,
                      "SELECT 1 FROM caption_words WHERE caption_words MATCH ? AND rowid BETWEEN "
                      "? AND ? LIMIT 1");
  row.bind(1, fts_query).bind(2, clip_id * kCaptionsOfClip);
  return row.bind(3, (clip_id + 1) * kCaptionsOfClip - 1).step();
}

std::vector<CaptionMatch> Database::match_captions(const std::string& fts_query, int limit) const {
  const SqliteConnection& connection = impl_->connection;
  SqliteStatement rows(connection,
                       "SELECT rowid / 1024, bm25(caption_words) AS score FROM caption_words "
                       "WHERE caption_words MATCH ? ORDER BY score, rowid");
  rows.bind(1, fts_query);
  std::vector<CaptionMatch> matches;
  std::unordered_set<int64_t> seen;
  try {
    while (limit < 0 || matches.size() < static_cast<size_t>(limit)) {
      if (!rows.step()) break;
      const int64_t id = rows.integer(0);
      if (seen.insert(id).second) matches.push_back({id, rows.real(1)});
    }
  } catch (const Error&) {
    if (sqlite3_errcode(connection.handle()) != SQLITE_ERROR) throw;
    const std::string message = sqlite3_errmsg(connection.handle());
    throw Error(
        "'" + fts_query + "' is not a valid query" + error_place(fts_query, message) + " (" +
        message +
        R"(); use words, "phrases", prefix*, AND, OR, NOT and brackets, and put words with )"
        R"(other signs into "quotes")");
  }
  return matches;
}

}  // namespace remomask::db
