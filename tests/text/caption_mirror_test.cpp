#include "text/caption_mirror.h"

#include <gtest/gtest.h>

namespace remomask {

TEST(CaptionMirror, ExchangesSides) {
  const std::pair<const char*, const char*> cases[] = {
      {"a person turns left.", "a person turns right."},
      {"Left hand up, RIGHT foot down", "Right hand up, LEFT foot down"},
      {"a left-handed throw", "a right-handed throw"},
      {"walks leftwards, then rightward", "walks rightwards, then leftward"},
      {"walks clockwise", "walks counterclockwise"},
      {"Counter-clockwise circle", "Clock-wise circle"},
      {"the leftovers are bright", "the leftovers are bright"},
      {"on his left the person waves", "on his right the person waves"},
      {"a man left foot first", "a man right foot first"},
      {"left/right, left", "right/left, right"},
      {"", ""},
  };
  for (const auto& [plain, mirrored] : cases) {
    EXPECT_EQ(text::mirror_caption(plain), mirrored);
    EXPECT_EQ(text::mirror_caption(mirrored), plain);
  }
}

TEST(CaptionMirror, LeavesThePastTenseOfLeave) {
  for (const char* caption : {"he left the room", "A person left the building quickly",
                              "the dog barks after she has left.", "they have left the stage"}) {
    EXPECT_EQ(text::mirror_caption(caption), caption);
  }
  EXPECT_EQ(text::mirror_caption("he left the room on the left side"),
            "he left the room on the right side");
}

TEST(CaptionMirror, TwiceIsTheIdentityForAwkwardText) {
  for (const char* caption :
       {"he right the room", "anticlockwise and Anti-clockwise", "counter clockwise clock wise",
        "counter clock-wise turn", "LeFt rIGHT", "has left, has right arm", "ANTICLOCKWISE", "left",
        "gegen den Uhrzeigersinn \xC3\xBC left", "sunwise", "clockwise-left right hand-left"}) {
    EXPECT_EQ(text::mirror_caption(text::mirror_caption(caption)), caption);
  }
  EXPECT_EQ(text::mirror_caption("anticlockwise"), "sunwise");
}

}  // namespace remomask
