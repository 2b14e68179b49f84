#include "search/sentence.h"

#include <gtest/gtest.h>

namespace remomask {
namespace {

using Words = std::vector<std::string>;

TEST(Sentence, TakesWordsBehindAMinusOut) {
  const search::Sentence sentence = search::parse_sentence("walk -backward slowly -arms");
  EXPECT_EQ(sentence.text, "walk slowly");
  EXPECT_EQ(sentence.unwanted, (Words{"backward", "arms"}));
  EXPECT_EQ(search::parse_sentence("-run walk").text, "walk");
  EXPECT_EQ(search::parse_sentence("walk\t-left-handed, please").unwanted, (Words{"left-handed"}));
  EXPECT_EQ(search::parse_sentence("geh -rückwärts").unwanted, (Words{"rückwärts"}));
}

TEST(Sentence, LeavesOtherMinusesAlone) {
  for (const char* text : {"a left-handed throw", "turn -90 degrees", "walk - then run",
                           "walk -- then run", "walk --fast", "step 3-4 times", "well- known"}) {
    EXPECT_EQ(search::parse_sentence(text).text, text);
    EXPECT_TRUE(search::parse_sentence(text).unwanted.empty()) << text;
  }
}

TEST(Sentence, MayBeEmpty) {
  EXPECT_EQ(search::parse_sentence(" ").text, "");
  const search::Sentence negatives = search::parse_sentence(" -run  -jump ");
  EXPECT_EQ(negatives.text, "");
  EXPECT_EQ(negatives.unwanted, (Words{"run", "jump"}));
}

}  // namespace
}  // namespace remomask
