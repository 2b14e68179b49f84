#include "text/wordpiece.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "remomask/error.h"

namespace remomask {
namespace {

std::vector<std::string> small_corpus() {
  return {"a person walks forward", "a person walks backward",   "a person is walking",
          "the man is jumping",     "the man jumps, then walks", "she waves the left hand"};
}

std::vector<std::string> hand_made_vocabulary() {
  return {"[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]", "walk", "##ing", "##i", "##n", "w", "##s"};
}

TEST(WordPiece, TakesTheLongestMatchFirst) {
  const text::WordPiece pieces(hand_made_vocabulary());
  EXPECT_EQ(pieces.encode("walking walks", 64).ids, (std::vector<int64_t>{2, 5, 6, 5, 10, 3}));
  EXPECT_EQ(pieces.encode("win", 64).ids, (std::vector<int64_t>{2, 9, 7, 8, 3}));
}

TEST(WordPiece, UnknownCharacterDoesNotHideItsWord) {
  const text::WordPiece pieces(hand_made_vocabulary());
  const text::TokenizedCaption encoded = pieces.encode("walk\u4e2ding", 64);
  EXPECT_EQ(encoded.ids, (std::vector<int64_t>{2, 5, text::WordPiece::kUnknown, 6, 3}));
  EXPECT_EQ(encoded.unknown, 1);
}

TEST(WordPiece, TextCannotSpellSpecialTokens) {
  const text::WordPiece pieces(text::train_wordpiece(small_corpus(), 300));
  for (const int64_t id : pieces.encode("[mask] [pad]", 64).ids)
    EXPECT_NE(id, text::WordPiece::kMask);
}

TEST(WordPiece, TrainingIsDeterministicAndIndependentOfOrder) {
  auto corpus = small_corpus();
  const auto vocabulary = text::train_wordpiece(corpus, 220);
  EXPECT_EQ(text::train_wordpiece(corpus, 220), vocabulary);
  std::reverse(corpus.begin(), corpus.end());
  EXPECT_EQ(text::train_wordpiece(corpus, 220), vocabulary);
}

TEST(WordPiece, FirstMergeIsTheOneOfHighestLikelihoodGain) {
  // Symbols: a 4, ##b 4, c 2, ##d 1, ##e 1; N = 12. Gains: ab 4 log(4 12 / 16)
  // = 4.39; cd and ce occur once and do not count.
  const auto vocabulary = text::train_wordpiece({"ab ab ab ab", "cd ce"}, 1000);
  const auto characters = static_cast<size_t>(
      std::find(vocabulary.begin(), vocabulary.end(), "ab") - vocabulary.begin());
  EXPECT_EQ(characters, vocabulary.size() - 1);
}

TEST(WordPiece, RoundTripAndNoUnknownForAscii) {
  const text::WordPiece pieces(text::train_wordpiece(small_corpus(), 300));
  for (const std::string caption : {"a person walks forward", "zebras quietly boxing 99"}) {
    const text::TokenizedCaption encoded = pieces.encode(caption, 64);
    EXPECT_EQ(encoded.unknown, 0);
    EXPECT_EQ(pieces.decode(encoded.ids), caption);
  }
}

TEST(WordPiece, LimitIsKeptAndReported) {
  const text::WordPiece pieces(text::train_wordpiece(small_corpus(), 300));
  std::string text;
  for (int i = 0; i < 100; ++i) text += "walks ";
  const text::TokenizedCaption encoded = pieces.encode(text, 64);
  EXPECT_EQ(encoded.ids.size(), 64u);
  EXPECT_EQ(encoded.ids.back(), text::WordPiece::kEnd);
  EXPECT_EQ(pieces.encode("walks", 64).dropped, 0);
  EXPECT_EQ(encoded.dropped % 38, 0);
  EXPECT_GE(encoded.dropped, 38);
}

TEST(WordPiece, RefusesForeignVocabularies) {
  EXPECT_THROW(text::WordPiece({"walk"}), Error);
  auto twice = hand_made_vocabulary();
  twice.push_back("walk");
  EXPECT_THROW(text::WordPiece{twice}, Error);
  EXPECT_THROW(text::train_wordpiece(small_corpus(), 20), Error);
}

}  // namespace
}  // namespace remomask
