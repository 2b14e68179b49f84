#include "pipeline/candidate_ranking.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include "pipeline/seams.h"

namespace remomask {
namespace {

TEST(RankCandidates, BestFirstAndEqualOnesInTheirOrder) {
  std::vector<Candidate> scores(4);
  scores[0].score = 0.2;
  scores[1].score = 0.5;
  scores[2].score = -1000;
  scores[3].score = 0.5;
  EXPECT_EQ(pipeline::rank_candidates(scores), (std::vector<int>{1, 3, 0, 2}));
  EXPECT_TRUE(pipeline::rank_candidates({}).empty());
}

/// All joints at x(t) = position[t].
Motion sliding(const std::vector<double>& position) {
  Motion motion(static_cast<int>(position.size()), 22);
  for (int t = 0; t < motion.frames; ++t) {
    for (int j = 0; j < 22; ++j)
      set_joint_position(motion, t, j, Vec3(position[static_cast<size_t>(t)], 1, 0));
  }
  return motion;
}

TEST(JerkOverTime, IsTheThirdDifference) {
  // Differences of 0 0 0 1 1 1: third ones 1, -2, 1.
  const std::vector<double> jerk =
      pipeline::jerk_over_time(sliding({0, 0, 0, 1, 1, 1}), humanml_skeleton());
  ASSERT_EQ(jerk.size(), 3u);
  EXPECT_NEAR(jerk[0], 8000, 1e-6);
  EXPECT_NEAR(jerk[1], 16000, 1e-6);
  EXPECT_NEAR(jerk[2], 8000, 1e-6);
  EXPECT_TRUE(pipeline::jerk_over_time(sliding({0, 0, 0}), humanml_skeleton()).empty());
}

TEST(JerkAtSeam, CountsFramesOnBothSidesAlone) {
  std::vector<double> position(40, 0);
  for (size_t t = 20; t < 40; ++t) position[t] = 1;
  const std::vector<double> jerk = pipeline::jerk_over_time(sliding(position), humanml_skeleton());
  // Entries 20-5-3 .. 20+5-1 are 13, three of which are not zero.
  EXPECT_NEAR(pipeline::jerk_at_seam(jerk, 20), (8000 + 16000 + 8000) / 13., 1e-6);
  EXPECT_EQ(pipeline::jerk_at_seam(jerk, 31), 0);
  EXPECT_EQ(pipeline::jerk_at_seam({}, 3), 0);
}

TEST(LowestFootOverTime, TakesTheLowestOfFourJoints) {
  Motion motion = sliding({0, 0});
  motion.at(1, 11)[1] = -0.25f;
  EXPECT_EQ(pipeline::lowest_foot_over_time(motion, humanml_skeleton()),
            (std::vector<double>{1, -0.25}));
}

}  // namespace
}  // namespace remomask
