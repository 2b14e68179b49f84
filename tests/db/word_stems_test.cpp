#include "db/word_stems.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace remomask {
namespace {

TEST(WordStems, ReadsAsTheFullTextIndexDoes) {
  const db::WordStems stems;
  const std::string text = "Walking, the person's push-ups: Ünïcode!";
  std::vector<std::string> found, typed;
  for (const db::StemmedWord& word : stems.read(text)) {
    found.push_back(word.stem);
    typed.push_back(text.substr(word.begin, word.end - word.begin));
  }
  EXPECT_EQ(found,
            (std::vector<std::string>{"walk", "the", "person", "s", "push", "up", "unicod"}));
  EXPECT_EQ(typed,
            (std::vector<std::string>{"Walking", "the", "person", "s", "push", "ups", "Ünïcode"}));
}

TEST(WordStems, KnowsTextsWithoutAWord) {
  const db::WordStems stems;
  EXPECT_TRUE(stems.read("").empty());
  EXPECT_TRUE(stems.read("?! -").empty());
  EXPECT_EQ(stems.stem("jacks"), "jack");
  EXPECT_EQ(stems.stem("..."), "");
}

}  // namespace
}  // namespace remomask
