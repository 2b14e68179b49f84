#include "text/bert_wordpiece.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/file.h"
#include "remomask/error.h"

namespace remomask {
namespace {

/// The special tokens are where no constant would find them.
std::vector<std::string> small_bert_vocabulary() {
  return {"walk",  "##s", "##ing", "[SEP]",  "[UNK]", "push",   "-", "ups", "[CLS]", "'",
          "doesn", "t",   "[PAD]", "[MASK]", "elan",  "\u8d70", "!", "a",   "##a",   "x"};
}

std::vector<int64_t> ids_of(const std::string& text, int64_t most = 64) {
  return text::BertWordPiece(small_bert_vocabulary()).encode(text, most).ids;
}

TEST(BertWordPiece, SpecialTokensAreFoundByName) {
  const text::BertWordPiece pieces(small_bert_vocabulary());
  EXPECT_EQ(pieces.encode("", 64).ids, (std::vector<int64_t>{8, 3}));
  EXPECT_EQ(pieces.encode("Walks", 64).ids, (std::vector<int64_t>{8, 0, 1, 3}));
  EXPECT_EQ(pieces.mask_id(), 13);
  EXPECT_EQ(pieces.pad_id(), 12);
  // Text cannot spell them.
  for (const int64_t id : pieces.encode("[MASK] [PAD]", 64).ids) {
    EXPECT_NE(id, pieces.mask_id());
    EXPECT_NE(id, pieces.pad_id());
  }
}

TEST(BertWordPiece, UnicodeIsReadAsBertDoes) {
  EXPECT_EQ(ids_of("\u00c9lan"), (std::vector<int64_t>{8, 14, 3}));
  EXPECT_EQ(ids_of("e\u0301lan"), (std::vector<int64_t>{8, 14, 3}));
  EXPECT_EQ(ids_of("a\u8d70a"), (std::vector<int64_t>{8, 17, 15, 17, 3}));
  EXPECT_EQ(ids_of("wa\u00adlk\u00a0wa\u200blk"), (std::vector<int64_t>{8, 0, 0, 3}));
  EXPECT_EQ(ids_of(std::string("wa\0lk\xff", 6) + "s\t!"), (std::vector<int64_t>{8, 0, 1, 16, 3}));
  EXPECT_EQ(ids_of("walk\u2028walk"), (std::vector<int64_t>{8, 0, 0, 3}));
  EXPECT_EQ(ids_of("\U0001F44B walk"), (std::vector<int64_t>{8, 4, 0, 3}));
}

TEST(BertWordPiece, AWordWithoutMatchOrTooLongIsUnknownAsAWhole) {
  EXPECT_EQ(ids_of("walkz walk"), (std::vector<int64_t>{8, 4, 0, 3}));
  EXPECT_EQ(ids_of(std::string(100, 'a'), 200).size(), 102u);
  EXPECT_EQ(ids_of(std::string(101, 'a')), (std::vector<int64_t>{8, 4, 3}));
}

TEST(BertWordPiece, RulesOfCasedVocabularies) {
  const text::BertWordPiece cased(small_bert_vocabulary(), {false, false});
  EXPECT_EQ(cased.encode("walk Walk", 64).ids, (std::vector<int64_t>{8, 0, 4, 3}));
  EXPECT_EQ(cased.encode("\u00e9lan", 64).ids, (std::vector<int64_t>{8, 4, 3}));
}

TEST(BertWordPiece, WordsKnowTheirBytesAndPieces) {
  const std::string text = " E\u0301lan, Push-Ups doesn't zz walk-";
  const text::BertTokens tokens = text::BertWordPiece(small_bert_vocabulary()).encode(text, 64);
  ASSERT_EQ(tokens.words.size(), 5u);
  const char* typed[] = {"E\u0301lan", "Push-Ups", "doesn't", "zz", "walk"};
  const char* normal[] = {"elan", "push-ups", "doesn't", "zz", "walk"};
  for (size_t i = 0; i < 5; ++i) {
    const text::WordSpan& word = tokens.words[i];
    EXPECT_EQ(text.substr(word.begin, word.end - word.begin), typed[i]);
    EXPECT_EQ(word.normal, normal[i]);
    EXPECT_EQ(word.known, i != 3);
  }
  EXPECT_EQ(tokens.words[1].first, 3u);  // after [CLS], elan and the comma
  EXPECT_EQ(tokens.words[1].count, 3u);
  EXPECT_EQ(tokens.ids.size(), tokens.words[4].first + 3);  // the walk, a hyphen, [SEP]
}

TEST(BertWordPiece, LongTextsAreCutAndSaySo) {
  const text::BertWordPiece pieces(small_bert_vocabulary());
  const text::BertTokens tokens = pieces.encode("walk walks walking push", 6);
  EXPECT_EQ(tokens.ids, (std::vector<int64_t>{8, 0, 0, 1, 0, 3}));
  EXPECT_EQ(tokens.dropped, 2);
  EXPECT_EQ(tokens.words.size(), 2u);  // of "walking" a piece is missing
}

TEST(BertWordPiece, AlienVocabulariesAreErrors) {
  std::vector<std::string> vocabulary = small_bert_vocabulary();
  vocabulary.push_back("walk");
  EXPECT_THROW(text::BertWordPiece{vocabulary}, Error);
  vocabulary = small_bert_vocabulary();
  vocabulary[4] = "[unused]";
  EXPECT_THROW(text::BertWordPiece{vocabulary}, Error);
  vocabulary = small_bert_vocabulary();
  vocabulary.push_back("\xff");
  EXPECT_THROW(text::BertWordPiece{vocabulary}, Error);
}

TEST(BertWordPiece, VocabularyFilesNameTheBadLine) {
  const std::string path = testing::TempDir() + "/bert_vocabulary.txt";
  write_file_atomically(path, "walk\r\n##s\n\u8d70");
  EXPECT_EQ(text::read_bert_vocabulary(path), (std::vector<std::string>{"walk", "##s", "\u8d70"}));
  for (const char* content : {"walk\n\xff\xfe\n", "walk\n\nrun\n"}) {
    write_file_atomically(path, content);
    try {
      text::read_bert_vocabulary(path);
      FAIL() << "no error";
    } catch (const FileError& error) {
      EXPECT_EQ(error.line(), 2);
    }
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace remomask
