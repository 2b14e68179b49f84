#include "search/spelling.h"

#include <gtest/gtest.h>

#include <set>

#include "search/coverage.h"
#include "search/subject.h"
#include "search/word_ranking.h"

namespace remomask {
namespace {

TEST(SpellingTest, CountsSteps) {
  EXPECT_EQ(search::edit_distance("walks", "walks", 2), 0);
  EXPECT_EQ(search::edit_distance("waks", "walks", 2), 1);
  EXPECT_EQ(search::edit_distance("walsk", "walks", 2), 1);
  EXPECT_EQ(search::edit_distance("wilks", "walks", 2), 1);
  EXPECT_EQ(search::edit_distance("kitten", "sitting", 5), 3);
  EXPECT_EQ(search::edit_distance("kitten", "sitting", 2), 3);
  EXPECT_EQ(search::edit_distance("", "ab", 5), 2);
}

TEST(SpellingTest, CorrectsWhatIsNoWord) {
  const std::set<std::string> english = {"violin", "plays", "the"};
  const auto is_word = [&](const std::string& word) { return english.contains(word); };
  const std::unordered_map<std::string, int> vocabulary = {
      {"walks", 9}, {"walk", 20}, {"forward", 5}, {"violet", 3}, {"jump", 1}};
  const auto read = search::correct_spelling("He waks foward, Jmup!", is_word, vocabulary);
  EXPECT_EQ(read.text, "He walks forward, jump!");
  ASSERT_EQ(read.corrected.size(), 3u);
  EXPECT_EQ(read.corrected[0].typed, "waks");
  EXPECT_EQ(read.corrected[0].read, "walks");
  EXPECT_EQ(read.corrected[2].typed, "Jmup");
  // A word of the language stays, however near another one is, and so does what is near nothing.
  EXPECT_EQ(search::correct_spelling("plays the violin xyzzy", is_word, vocabulary).text,
            "plays the violin xyzzy");
  // Short words and words of another first letter are left alone.
  EXPECT_EQ(search::correct_spelling("wlk talks", is_word, vocabulary).text, "wlk talks");
}

TEST(SpellingTest, WhoMovesIsAPerson) {
  for (const char* text : {"a girl waves", "the robot  waves", "He waves", "someone waves",
                           "Bro waves", "a person waves"}) {
    EXPECT_EQ(search::generic_subject(text), "a person waves") << text;
  }
  // No subject, or not before a verb.
  for (const char* text : {"robot dance", "waves", "the waves", "man", "", "she", "a girl his"}) {
    EXPECT_EQ(search::generic_subject(text), text);
  }
}

TEST(SpellingTest, KnowsFunctionWordsAndSides) {
  EXPECT_TRUE(search::is_function_word("someone"));
  EXPECT_FALSE(search::is_function_word("kicks"));
  EXPECT_EQ(search::named_sides("raise the Left hand"), 1u);
  EXPECT_EQ(search::named_sides("turns clockwise"), 2u);
  EXPECT_EQ(search::named_sides("left, then right"), 3u);
  EXPECT_EQ(search::named_sides("walks"), 0u);
}

}  // namespace
}  // namespace remomask
