#include "pipeline/editing.h"
#include "motion/vector.h"

#include <gtest/gtest.h>
#include <torch/types.h>

#include "generator/token_windows.h"
#include "motion/body_parts.h"
#include "motion/rotation.h"
#include "remomask/error.h"
#include "tests/generator/tiny_model.h"

namespace remomask {
namespace {

/// A walk as another program may have stored it: anywhere, and of another size.
const Motion& foreign_walk() {
  static const Motion motion = [] {
    Motion walk = motion::recover_motion(swinging_features(70, 2), humanml_skeleton());
    const Quat turn = motion::yaw_rotation(1.1);
    for (int t = 0; t < walk.frames; ++t) {
      for (int j = 0; j < walk.joints; ++j) {
        set_joint_position(walk, t, j, 0.9 * (turn * joint_position(walk, t, j)) + Vec3(2, 0.3, 5));
      }
    }
    return walk;
  }();
  return motion;
}

void expect_only_cells_change(const pipeline::Edited& edited, const Motion& before) {
  const std::vector<int> parts = motion::joint_parts(humanml_skeleton());
  for (int t = 0; t < before.frames; ++t) {
    for (int j = 0; j < 22; ++j) {
      const bool changes = edited.mask.has(t, parts[static_cast<size_t>(j)]);
      const bool equal = std::equal(before.at(t, j), before.at(t, j) + 3, edited.motion.at(t, j));
      ASSERT_TRUE(changes || equal) << "frame " << t << " joint " << j;
    }
  }
}

double worst_bone_error(const Motion& motion, const Motion& before) {
  const Skeleton& skeleton = humanml_skeleton();
  double worst = 0;
  for (int t = 0; t < motion.frames; ++t) {
    for (int j = 1; j < 22; ++j) {
      const int parent = skeleton.parents[static_cast<size_t>(j)];
      worst = std::max(
          worst,
          std::abs((joint_position(motion, t, j) - joint_position(motion, t, parent)).norm() -
                   (joint_position(before, 0, j) - joint_position(before, 0, parent)).norm()));
    }
  }
  return worst;
}

TEST(EditMotion, OnlyTheNamedCellsChange) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  const Motion& before = foreign_walk();
  const std::vector<std::vector<pipeline::CellSpan>> edits = {
      {{20, 45, {}}},      // in between
      {{0, 17, {}}},       // the beginning
      {{50, 70, {}}},      // the end
      {{0, 70, {4}}},      // the left arm
      {{10, 30, {0, 1}}},  // the legs
      {{10, 30, {2}}},     // the spine between fixed limbs
      {{5, 20, {5}}, {15, 30, {}}, {40, 61, {3, 4}}},
      {{0, 70, {}}},  // all of it
  };
  for (const std::vector<pipeline::CellSpan>& spans : edits) {
    EditOptions options;
    options.seed = 3;
    const pipeline::Edited edited =
        pipeline::edit_motion(generator, before, spans, "a man waves", {}, options);
    ASSERT_EQ(edited.motion.frames, before.frames);
    expect_only_cells_change(edited, before);
    EXPECT_NE(edited.motion.positions, before.positions);
    EXPECT_LT(worst_bone_error(edited.motion, before), 1e-4);
    EXPECT_GT(edited.tokens_sampled, 0);
    const pipeline::Edited again =
        pipeline::edit_motion(generator, before, spans, "a man waves", {}, options);
    EXPECT_EQ(again.motion.positions, edited.motion.positions);
    options.seed = 4;
    const pipeline::Edited other =
        pipeline::edit_motion(generator, before, spans, "a man waves", {}, options);
    EXPECT_NE(other.motion.positions, edited.motion.positions);
  }
}

TEST(EditMotion, SamplesOnlyCellsWithFramesThatChange) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  const pipeline::Edited edited =
      pipeline::edit_motion(generator, foreign_walk(), {{6, 13, {4}}}, "a man waves", {});
  EXPECT_EQ(edited.tokens, 18 * 6);     // 70 frames fill 18 token frames
  EXPECT_EQ(edited.tokens_sampled, 3);  // frames 4-7, 8-11 and 12-15 of one row
}

TEST(EditMotion, ContinuesFromTheLastPose) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  const Motion& before = foreign_walk();
  EditOptions options;
  options.extend_frames = 33;
  const pipeline::Edited edited =
      pipeline::edit_motion(generator, before, {}, "a person walks", {}, options);
  ASSERT_EQ(edited.motion.frames, 103);
  expect_only_cells_change(edited, before);
  EXPECT_LT(worst_bone_error(edited.motion, before), 1e-4);
  EXPECT_LT((joint_position(edited.motion, 70, 0) - joint_position(before, 69, 0)).norm(), 0.3);
}

TEST(EditMotion, WhatCannotBeEditedIsAnError) {
  const pipeline::Generator generator(tiny_model().stages, tiny_words());
  const Motion& before = foreign_walk();
  const auto edit = [&](const std::vector<pipeline::CellSpan>& spans) {
    return pipeline::edit_motion(generator, before, spans, "a man waves", {});
  };
  EXPECT_THROW(edit({}), Error);
  EXPECT_THROW(edit({{60, 71, {}}}), Error);
  EXPECT_THROW(edit({{-1, 5, {}}}), Error);
  EXPECT_THROW(edit({{5, 5, {}}}), Error);
  EXPECT_THROW(edit({{0, 5, {6}}}), Error);
  EXPECT_THROW(pipeline::edit_motion(generator, slice(before, 0, 3), {{0, 2, {}}}, "waves", {}),
               Error);
}

TEST(PlanWindows, ShortStretchesSeeWhatIsKnownAround) {
  at::Tensor known = torch::ones({60, 6}, torch::kBool);
  known.slice(0, 20, 30).select(1, 4).fill_(false);
  auto windows = generator::plan_windows(known, 20, 30);
  ASSERT_EQ(windows.size(), 1u);
  EXPECT_EQ(windows[0].first, 12);
  EXPECT_EQ(windows[0].last, 38);
  known.slice(0, 33, 60).fill_(false);
  known[15][0] = false;
  windows = generator::plan_windows(known, 20, 30);
  EXPECT_EQ(windows[0].first, 16);
  EXPECT_EQ(windows[0].last, 33);
}

TEST(PlanWindows, LongStretchesAreCut) {
  at::Tensor known = torch::zeros({120, 6}, torch::kBool);
  known.slice(0, 0, 3).fill_(true);
  known.slice(0, 103, 120).fill_(true);
  const auto windows = generator::plan_windows(known, 3, 103);  // 100 frames in pieces of 25
  ASSERT_EQ(windows.size(), 4u);
  const int64_t firsts[] = {0, 20, 45, 70}, lasts[] = {28, 53, 78, 111};
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(windows[i].first, firsts[i]);
    EXPECT_EQ(windows[i].last, lasts[i]);
  }
  EXPECT_THROW(generator::plan_windows(known, 3, 121), Error);
  EXPECT_THROW(generator::plan_windows(known, 5, 5), Error);
}

}  // namespace
}  // namespace remomask
