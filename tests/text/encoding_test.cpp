#include "text/encoding.h"

#include <gtest/gtest.h>

namespace remomask {

TEST(TextEncoding, MarksVanishAndUtf16BecomesUtf8) {
  EXPECT_EQ(text::utf8_text("a\n"), "a\n");
  EXPECT_EQ(text::utf8_text(""), "");
  EXPECT_EQ(text::utf8_text("\xEF\xBB\xBF"), "");
  EXPECT_EQ(text::utf8_text("\xEF\xBB\xBF\xC3\xA4"), "\xC3\xA4");
  EXPECT_EQ(text::utf8_text("\xE4 bytes of another encoding stay"),
            "\xE4 bytes of another encoding stay");
  const std::string utf8 = "a\xC3\xA4\xE6\x97\xA5\xF0\x9F\x99\x82";  // a, ä, 日, a smile
  EXPECT_EQ(text::utf8_text(std::string("\xFF\xFE"
                                        "a\0\xE4\0\xE5\x65\x3D\xD8\x42\xDE",
                                        12)),
            utf8);
  EXPECT_EQ(text::utf8_text(std::string("\xFE\xFF\0a\0\xE4\x65\xE5\xD8\x3D\xDE\x42", 12)), utf8);
  EXPECT_EQ(text::utf8_text(std::string("a\0b\0", 4)), "ab");
  EXPECT_EQ(text::utf8_text(std::string("\0a\0b", 4)), "ab");
  // Half of a pair, and half of a unit at the end.
  EXPECT_EQ(text::utf8_text(std::string("\xFF\xFE\x3D\xD8\x61\0\x62", 7)),
            "\xEF\xBF\xBD"
            "a");
}

TEST(TextEncoding, LinesEndInOneWayAndEveryLineIsUtf8) {
  EXPECT_EQ(text::utf8_lines(""), "");
  EXPECT_EQ(text::utf8_lines("a\nb"), "a\nb");
  EXPECT_EQ(text::utf8_lines("a\r\nb\r\r\nc\r"), "a\nb\n\nc\n");
  EXPECT_EQ(text::utf8_lines("caf\xC3\xA9\ncaf\xE9 \x93quoted\x94 \x80\r"),
            "caf\xC3\xA9\ncaf\xC3\xA9 \xE2\x80\x9Cquoted\xE2\x80\x9D \xE2\x82\xAC\n");
}

TEST(TextEncoding, KnowsUtf8) {
  EXPECT_TRUE(text::is_utf8(""));
  EXPECT_TRUE(text::is_utf8("a\xC3\xA4\xE6\x97\xA5\xF0\x9F\x99\x82"));
  for (const char* broken :
       {"\xE4", "\xC3", "\xC0\x80", "\x80", "\xE6\x97", "\xF8\x88\x80\x80\x80"}) {
    EXPECT_FALSE(text::is_utf8(broken));
  }
}

}  // namespace remomask
