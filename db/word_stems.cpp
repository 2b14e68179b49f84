#include "db/word_stems.h"

#include "db/sqlite.h"
#include "remomask/error.h"

namespace remomask::db {

namespace {

int add_word(void* words, int /*flags*/, const char* stem, int bytes, int begin, int end) {
  static_cast<std::vector<StemmedWord>*>(words)->push_back(
      {std::string(stem, static_cast<size_t>(bytes)), static_cast<size_t>(begin),
       static_cast<size_t>(end)});
  return SQLITE_OK;
}

/// FTS5's interface for extensions, as its documentation asks for it.
fts5_api* full_text_api(const SqliteConnection& connection) {
  fts5_api* api = nullptr;
  SqliteStatement row(connection, "SELECT fts5(?1)");
  row.bind_pointer(1, &api, "fts5_api_ptr");
  row.step();
  if (!api) throw Error("this build of SQLite has no full-text search (FTS5)");
  return api;
}

}  // namespace

struct WordStems::Impl {
  SqliteConnection connection{":memory:", SqliteMode::create};
  fts5_tokenizer functions{};
  Fts5Tokenizer* tokenizer = nullptr;
  std::mutex mutex;  // of the tokenizer, which has one buffer

  Impl() {
    fts5_api* const api = full_text_api(connection);
    void* context = nullptr;
    const char* inner = "unicode61";
    if (api->xFindTokenizer(api, "porter", &context, &functions) != SQLITE_OK ||
        functions.xCreate(context, &inner, 1, &tokenizer) != SQLITE_OK) {
      throw Error("this build of SQLite has no tokenizer 'porter unicode61'");
    }
  }
  ~Impl() { functions.xDelete(tokenizer); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
};

WordStems::WordStems() : impl_(std::make_unique<Impl>()) {}
WordStems::~WordStems() = default;

std::vector<StemmedWord> WordStems::read(std::string_view text) const {
  std::vector<StemmedWord> words;
  const std::scoped_lock lock(impl_->mutex);
  const int code =
      impl_->functions.xTokenize(impl_->tokenizer, &words, FTS5_TOKENIZE_QUERY, text.data(),
                                 static_cast<int>(text.size()), &add_word);
  if (code != SQLITE_OK) impl_->connection.fail(code);
  return words;
}

std::string WordStems::stem(std::string_view word) const {
  const std::vector<StemmedWord> words = read(word);
  return words.empty() ? "" : words.front().stem;
}

}  // namespace remomask::db
