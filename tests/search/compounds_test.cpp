#include "search/compounds.h"

#include <gtest/gtest.h>

#include <map>

namespace remomask {
namespace {

const db::WordStems& shared_stems() {
  static const db::WordStems stems;
  return stems;
}

TEST(CompoundsTest, AllSpellingsBecomeTheUsualOne) {
  for (const auto& [typed, usual] :
       std::map<std::string, std::string>{{"ten pushups", "ten push-ups"},
                                          {"push ups!", "push-ups!"},
                                          {"does a push up", "does a push-up"},
                                          {"Push-Ups", "Push-Ups"},
                                          {"jumping-jacks", "jumping jacks"},
                                          {"jumpingjacks", "jumping jacks"},
                                          {"tip toes and moon walks", "tiptoes and moonwalks"},
                                          {"a cart-wheel", "a cartwheel"},
                                          {"cross legged", "cross-legged"}}) {
    EXPECT_EQ(search::usual_spelling(typed, shared_stems()), usual);
  }
}

TEST(CompoundsTest, TwoWordsStayTwo) {
  for (const char* text : {"he pushes up", "push up the box", "pull up", "the left hand",
                           "jumps up", "five high", "push, ups", "walks on tip of the toe", ""}) {
    EXPECT_EQ(search::usual_spelling(text, shared_stems()), text);
  }
}

TEST(CompoundsTest, AllFormsHaveOneStem) {
  for (const char* text : {"pushup", "push-up", "push ups", "a push up", "PUSHUPS"}) {
    const std::string typed = text;
    const auto compounds = search::find_compounds(typed, shared_stems().read(typed));
    ASSERT_EQ(compounds.size(), 1u) << text;
    EXPECT_EQ(compounds.front().stem, "pushup") << text;
  }
}

}  // namespace
}  // namespace remomask
