#include "evaluation/moment_tasks.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "evaluation/joined_motion.h"
#include "motion/heading.h"
#include "remomask/error.h"
#include "synthetic/procedural.h"

namespace remomask {
namespace {

TEST(JoinedMotion, GoesOnWhereTheOneBeforeEnded) {
  const Skeleton& skeleton = humanml_skeleton();
  const Motion turn = synthetic::make_procedural_clip("walk-circle-left").motion;
  const Motion walk = synthetic::make_procedural_clip("walk-forward").motion;
  const Motion joined = evaluation::join_motions({turn, walk, turn}, skeleton);
  ASSERT_EQ(joined.frames, 2 * turn.frames + walk.frames);
  // The first is unchanged, a later one is moved as a whole after the fade.
  EXPECT_TRUE(std::equal(turn.positions.begin(), turn.positions.end(), joined.positions.begin()));
  for (int t = 5; t < walk.frames; ++t) {
    for (int j = 1; j < skeleton.joints(); ++j) {
      const double before =
          (joint_position(walk, t, j) - joint_position(walk, walk.frames - 1, 0)).norm();
      const double after = (joint_position(joined, turn.frames + t, j) -
                            joint_position(joined, turn.frames + walk.frames - 1, 0))
                               .norm();
      ASSERT_NEAR(before, after, 1e-4);
    }
    EXPECT_NEAR(joint_position(walk, t, 0).y(), joint_position(joined, turn.frames + t, 0).y(),
                1e-5);
  }
  // No joint jumps at a seam, and the walk goes where the body faces.
  for (const int seam : {turn.frames, turn.frames + walk.frames}) {
    for (int j = 0; j < skeleton.joints(); ++j) {
      EXPECT_LT((joint_position(joined, seam, j) - joint_position(joined, seam - 1, j)).norm(), 0.2)
          << j;
    }
  }
  const Vec3 facing =
      Vec3::UnitY().cross(motion::across_body(joined, turn.frames - 1, skeleton)).normalized();
  const Vec3 way = joint_position(joined, turn.frames + walk.frames - 1, 0) -
                   joint_position(joined, turn.frames - 1, 0);
  EXPECT_GT(way.normalized().dot(facing), 0.95);
  EXPECT_THROW(evaluation::join_motions({}, skeleton), Error);
  EXPECT_THROW(evaluation::join_motions({turn, Motion(0, 22)}, skeleton), Error);
}

std::vector<db::TrainingClip> procedural_set(int count) {
  std::vector<db::TrainingClip> clips;
  for (const synthetic::ProceduralClip& made : synthetic::make_procedural_clips({count, 1})) {
    db::TrainingClip& clip = clips.emplace_back();
    clip.name = made.name;
    clip.group = static_cast<int>(clips.size());
    clip.captions = made.captions;
    clip.content = made.labels["content"].get<std::string>();
    clip.features = motion::extract_features_all_frames(made.motion, humanml_skeleton(),
                                                        motion::FeatureMode::fixed);
  }
  return clips;
}

TEST(MomentTasks, ClipsOfDifferentContentsOneAfterTheOther) {
  const auto clips = procedural_set(20);
  const evaluation::MomentTasks tasks(clips, motion::FeatureMode::fixed, {25, 3, 7});
  ASSERT_EQ(tasks.size(), 25u);
  std::set<std::string> sentences;
  std::set<size_t> places;
  for (size_t i = 0; i < tasks.size(); ++i) {
    const evaluation::MomentTask task = tasks.task(i);
    ASSERT_EQ(task.parts.size(), 3u);
    std::set<std::string> contents;
    int first = 0;
    for (size_t p = 0; p < 3; ++p) {
      const db::TrainingClip& clip = clips[task.clips[p]];
      contents.insert(clip.content);
      EXPECT_EQ(task.parts[p], (search::MomentWindow{first, first + clip.features.frames}));
      first = task.parts[p].last;
    }
    EXPECT_EQ(contents.size(), 3u);
    EXPECT_EQ(task.features.frames, first);
    EXPECT_EQ(task.sentence, clips[task.clips[task.asked]].captions.front());
    sentences.insert(task.sentence);
    places.insert(task.asked);
  }
  EXPECT_GE(sentences.size(), 18u);  // every clip is asked for before one is again
  EXPECT_EQ(places.size(), 3u);
  const evaluation::MomentTask again =
      evaluation::MomentTasks(clips, motion::FeatureMode::fixed, {3, 3, 7}).task(2);
  EXPECT_EQ(again.features.values, tasks.task(2).features.values);
}

TEST(MomentTasks, TooFewContentsAreRefused) {
  auto clips = procedural_set(6);
  for (db::TrainingClip& clip : clips) clip.content = "walk";
  EXPECT_THROW(evaluation::MomentTasks(clips, motion::FeatureMode::fixed, {5, 3, 0}), Error);
  EXPECT_THROW(evaluation::MomentTasks(clips, motion::FeatureMode::fixed, {0, 3, 0}), Error);
}

}  // namespace
}  // namespace remomask
