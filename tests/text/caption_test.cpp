#include "text/caption.h"

#include <gtest/gtest.h>

#include <string>

#include "remomask/error.h"
#include "text/utf8.h"

namespace remomask {
namespace {

struct CaptionCase {
  const char *input, *expected;
};

TEST(Caption, NormalisesByTable) {
  const CaptionCase cases[] = {
      {"A person walks.", "a person walks"},
      {"  Two\t blanks\n and\u00a0one\u3000wide ", "two blanks and one wide"},
      {"he\u2019s \u201cproud\u201d \u2013 very", "he's \"proud\" - very"},
      {"walks 4 steps, then 20.", "walks four steps, then twenty"},
      {"turns 180 degrees in 3.5 s, the 2nd time", "turns 180 degrees in 3.5 s, the 2nd time"},
      {"21 steps", "21 steps"},
      {"jumps...", "jumps"},
      {"Jump!", "jump"},
      {"who walks 4 times ?!", "who walks four times"},
      {"kick 2:", "kick two"},
      {"\"wait!\" he said", "\"wait!\" he said"},
      {"jumps\u2026 again", "jumps... again"},
      {"ZERO\u200bWIDTH \ufeffmark", "zerowidth mark"},
      {"\u00c4RGER \u0394\u03a3 \u0416", "\u00e4rger \u03b4\u03c3 \u0436"},
      {"\uff37\uff41\uff4c\uff4b", "walk"},
      {"broken \xff\xc3 bytes", "broken bytes"},
      {"", ""},
      {" . ", ""},
      {"?!", ""},
  };
  for (const CaptionCase& c : cases)
    EXPECT_EQ(text::normalise_caption(c.input), c.expected) << c.input;
}

TEST(Caption, IsIdempotent) {
  for (const char* text :
       {"A person walks 4 Steps.", "a\u2026b .", "\u201cX\u201d 7...", "12, 13", "kick 2!"}) {
    const std::string once = text::normalise_caption(text);
    EXPECT_EQ(text::normalise_caption(once), once);
  }
}

TEST(Caption, EmptyPromptIsAnErrorWithRemedy) {
  try {
    text::normalise_prompt(" \u200b. ");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("describe the motion"), std::string::npos);
  }
  EXPECT_EQ(text::normalise_prompt("Walk."), "walk");
}

TEST(Caption, VeryLongTextIsCut) {
  EXPECT_EQ(text::normalise_caption(std::string(100000, 'x')).size(), text::kMostCaptionBytes);
}

TEST(Caption, Utf8LeavesOutOverlongAndSurrogates) {
  EXPECT_EQ(text::decode_utf8("a\xc0\xaf"
                              "b"),
            (std::vector<char32_t>{'a', 'b'}));
  EXPECT_EQ(text::decode_utf8("\xed\xa0\x80"
                              "c"),
            (std::vector<char32_t>{'c'}));
  EXPECT_EQ(text::decode_utf8("\xf0\x9f\x98\x80"), (std::vector<char32_t>{0x1F600}));
  std::string text;
  for (const char32_t point : {0x41, 0xE4, 0x20AC, 0x1F600}) text::append_utf8(text, point);
  EXPECT_EQ(text, "A\u00e4\u20ac\U0001F600");
}

}  // namespace
}  // namespace remomask
