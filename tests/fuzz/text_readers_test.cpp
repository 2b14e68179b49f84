// Readers of text: files with captions, skeleton maps, and what is typed.
#include "base/file.h"
#include "db/captions_index.h"
#include "exchange/captions_file.h"
#include "exchange/humanml_texts.h"
#include "remomask/error.h"
#include "rig/skeleton_map.h"
#include "tests/db/db_test_tools.h"
#include "tests/fuzz/fuzz_test_tools.h"
#include "text/bert_wordpiece.h"
#include "text/caption.h"
#include "text/encoding.h"

namespace remomask {
namespace {

using TextReaderFuzz = ReaderFuzz;

TEST_F(TextReaderFuzz, Captions) {
  fuzz(corpus("captions"), 20, [&](const std::string& content) {
    exchange::CaptionsFile file(place("captions.jsonl", content));
  });
}

TEST_F(TextReaderFuzz, HumanmlTexts) {
  fuzz(corpus("humanml"), 40, [&](const std::string& content) {
    std::vector<std::string> warnings;
    exchange::read_humanml_texts(place("a.txt", content), warnings);
  });
}

TEST_F(TextReaderFuzz, SkeletonMaps) {
  fuzz({rig::format_skeleton_maps({rig::shipped_skeleton_maps()[0]})}, 20,
       [](const std::string& content) { rig::parse_skeleton_maps(content, "map.json"); });
}

TEST_F(TextReaderFuzz, Vocabulary) {
  fuzz(corpus("vocabulary"), 10, [&](const std::string& content) {
    text::BertWordPiece(text::read_bert_vocabulary(place("vocab.txt", content)));
  });
}

TEST_F(TextReaderFuzz, WordPieces) {
  const text::BertWordPiece words(text::read_bert_vocabulary(
      std::string(REMOMASK_SOURCE_DIR) + "/tests/fuzz/corpus/vocabulary/short.txt"));
  fuzz(corpus("sentence"), 200, [&](const std::string& content) {
    const text::BertTokens tokens = words.encode(content, 16);
    ASSERT_LE(tokens.ids.size(), 16u);
    for (const text::WordSpan& word : tokens.words) {
      ASSERT_LE(word.begin, word.end);
      ASSERT_LE(word.end, content.size());
    }
  });
}

TEST_F(TextReaderFuzz, Prompts) {
  fuzz(corpus("sentence"), 200, [&](const std::string& content) {
    const std::string prompt = text::normalise_prompt(text::utf8_text(content));
    ASSERT_EQ(text::normalise_caption(prompt), prompt);
  });
}

TEST_F(TextReaderFuzz, FullTextQueries) {
  db::Database database(folder_ / "d", db::OpenMode::create);
  database.add_clip(named_clip("a"), walking_motion(8, 1));
  fuzz(corpus("sentence"), 20, [&](const std::string& content) {
    const std::string query = db::quote_caption_words(content);
    // SQLite takes an embedded zero for the end of the query.
    if (!query.empty()) database.match_captions(query);
  });
}

}  // namespace
}  // namespace remomask
