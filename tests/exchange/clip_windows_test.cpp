#include "exchange/clip_windows.h"

#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

TEST(ClipWindows, ShortMotionsStayWhole) {
  EXPECT_EQ(exchange::clip_windows(20, {}), (std::vector<exchange::ClipWindow>{{0, 20}}));
  EXPECT_EQ(exchange::clip_windows(196, {}), (std::vector<exchange::ClipWindow>{{0, 196}}));
  EXPECT_EQ(exchange::clip_windows(200, {}), (std::vector<exchange::ClipWindow>{{0, 200}}));
}

TEST(ClipWindows, LastWindowEndsWithTheMotion) {
  // Step 156; the third window would be 312-508.
  EXPECT_EQ(exchange::clip_windows(400, {}),
            (std::vector<exchange::ClipWindow>{{0, 196}, {156, 352}, {204, 400}}));
  EXPECT_EQ(exchange::clip_windows(352, {}),
            (std::vector<exchange::ClipWindow>{{0, 196}, {156, 352}}));
}

TEST(ClipWindows, FewNewFramesMoveTheLastWindow) {
  // 19 new frames after 352: not a window of their own.
  EXPECT_EQ(exchange::clip_windows(371, {}),
            (std::vector<exchange::ClipWindow>{{0, 196}, {175, 371}}));
  EXPECT_EQ(exchange::clip_windows(372, {}),
            (std::vector<exchange::ClipWindow>{{0, 196}, {156, 352}, {176, 372}}));
  EXPECT_EQ(exchange::clip_windows(201, {}),
            (std::vector<exchange::ClipWindow>{{0, 121}, {80, 201}}));
}

TEST(ClipWindows, EveryFrameIsCoveredAndNoWindowIsTooLong) {
  for (int frames = 20; frames < 3000; ++frames) {
    const auto windows = exchange::clip_windows(frames, {});
    int covered = 0;
    for (const exchange::ClipWindow& window : windows) {
      ASSERT_LE(window.first, covered) << frames;
      ASSERT_LE(window.last - window.first, 200) << frames;
      ASSERT_GE(window.last - window.first, 20) << frames;
      ASSERT_GT(window.last, covered) << frames;
      covered = window.last;
    }
    ASSERT_EQ(covered, frames);
  }
}

TEST(ClipWindows, ContradictingOptionsAreRefused) {
  EXPECT_THROW(exchange::clip_windows(100, {20, 19, 0}), Error);
  EXPECT_THROW(exchange::clip_windows(100, {20, 60, 41}), Error);
  EXPECT_THROW(exchange::clip_windows(100, {1, 60, 0}), Error);
  EXPECT_THROW(exchange::clip_windows(100, {20, 60, -1}), Error);
}

}  // namespace
}  // namespace remomask
