#include "evaluation/moment_metrics.h"

#include <gtest/gtest.h>

namespace remomask {
namespace {

TEST(MomentMetrics, FiguresByHand) {
  const evaluation::MomentFigures figures = evaluation::moment_figures({0.5, 0.7, 0.49, 1}, {});
  EXPECT_DOUBLE_EQ(figures.recall_50, 75);
  EXPECT_DOUBLE_EQ(figures.recall_70, 50);
  EXPECT_DOUBLE_EQ(figures.mean_iou, 67.25);
  ASSERT_EQ(figures.intervals.size(), 3u);
  EXPECT_LE(figures.intervals[2].low, 67.25);
  EXPECT_GE(figures.intervals[2].high, 67.25);
  EXPECT_TRUE(evaluation::moment_figures({1}, {0, 0.95, 0}).intervals.empty());
  EXPECT_EQ(evaluation::moment_figures({}, {}).mean_iou, 0);
}

}  // namespace
}  // namespace remomask
