#include "search/query.h"
#include "motion/vector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "motion/body_parts.h"
#include "tests/db/db_test_tools.h"
#include "tests/index/index_test_tools.h"

namespace remomask {
namespace {

std::string refusal(const SearchQuery& query) {
  return error_of([&] { search::check_query(query); });
}

TEST(BodyPartNames, AreThoseOfTheMapAndPairsOfThem) {
  EXPECT_EQ(search::parse_body_parts({"left_arm"}), (std::vector<int>{4}));
  EXPECT_EQ(search::parse_body_parts({"arms", "left_leg", "right_arm"}),
            (std::vector<int>{0, 4, 5}));
  EXPECT_EQ(search::parse_body_parts({"legs", "torso", "arms"}),
            (std::vector<int>{0, 1, 2, 3, 4, 5}));
  const std::string error = error_of([] { search::parse_body_parts({"tail"}); });
  EXPECT_NE(error.find("'tail'"), std::string::npos);
  EXPECT_NE(error.find("upper_spine_head"), std::string::npos);
}

TEST(Query, RefusesWhatMakesNoSense) {
  SearchQuery query;
  EXPECT_NE(refusal(query).find("nothing to look for"), std::string::npos);
  query.parts = {"arms"};
  query.text = "walk";
  EXPECT_NE(refusal(query).find("--like"), std::string::npos);
  query.parts.clear();
  EXPECT_EQ(refusal(query), "");
  query.k = 0;
  EXPECT_NE(refusal(query).find("k of 1"), std::string::npos);
  query.k = 1;
  query.like_clip = "clip";
  query.text_weight = query.motion_weight = 0;
  EXPECT_NE(refusal(query).find("both zero"), std::string::npos);
  query.text_weight = -1;
  EXPECT_NE(refusal(query).find("weight of the sentence is -1"), std::string::npos);
  query.text_weight = 1;
  query.motion_weight = std::nan("");
  EXPECT_NE(refusal(query).find("weight of the motion"), std::string::npos);
  query.motion_weight = 0;
  EXPECT_EQ(refusal(query), "");
  query.motion = Motion(4, 22);
  EXPECT_NE(refusal(query).find("not both"), std::string::npos);
}

TEST(LinearQuery, WeighsSentenceAndMotion) {
  search::QueryVectors vectors;
  vectors.text = {1, 0};
  vectors.motion = {0, 1};
  vectors.motion_parts.assign(motion::kBodyParts * 1, 0.5f);
  SearchQuery query;
  query.text_weight = 3;
  const index::LinearQuery both = search::linear_query(vectors, query);
  EXPECT_EQ(both.global, (std::vector<float>{0.75f, 0.25f}));
  EXPECT_TRUE(both.parts.empty());
  query.parts = {"arms"};
  const index::LinearQuery arms = search::linear_query(vectors, query);
  EXPECT_EQ(arms.global, (std::vector<float>{0.75f, 0.f}));
  EXPECT_EQ(arms.parts, (std::vector<float>{0, 0, 0, 0, 0.0625f, 0.0625f}));
  query.motion_weight = 0;
  EXPECT_EQ(search::linear_query(vectors, query).global, vectors.text);
  EXPECT_TRUE(search::linear_query(vectors, query).parts.empty());
}

TEST(LinearQuery, WeightsMeanNothingToASingleSource) {
  SearchQuery query;
  query.text_weight = 0.2;
  query.motion_weight = 0;
  EXPECT_EQ(search::linear_query({{1, 0}, {}, {}}, query).global, (std::vector<float>{1, 0}));
  query.text_weight = 0;
  EXPECT_EQ(search::linear_query({{}, {0, 1}, {}}, query).global, (std::vector<float>{0, 1}));
}

TEST(VectorTable, SumsGlobalAndPartsAsTheDefinitionSays) {
  constexpr int kClips = 300, kWidth = 8, kPartWidth = 3;
  const auto globals = random_directions(kClips, kWidth, 1);
  const auto parts = random_directions(kClips * motion::kBodyParts, kPartWidth, 2);
  const size_t parts_width = motion::kBodyParts * kPartWidth;
  std::vector<db::ClipEmbedding> embeddings;
  for (size_t i = 0; i < kClips; ++i) {
    db::ClipEmbedding clip;
    clip.clip_id = static_cast<int64_t>(3 * i + 1);
    clip.motion.assign(&globals[i * kWidth], &globals[i * kWidth] + kWidth);
    clip.parts.assign(&parts[i * parts_width], &parts[i * parts_width] + parts_width);
    embeddings.push_back(std::move(clip));
  }
  embeddings[200] = embeddings[40];  // a tie: by id
  embeddings[200].clip_id = 601;
  const index::VectorTable table = index::VectorTable::of_bodies(embeddings);
  search::QueryVectors vectors{random_directions(1, kWidth, 3), embeddings[40].motion,
                               embeddings[40].parts};
  SearchQuery query;
  query.parts = {"arms", "root_lower_spine"};
  query.text_weight = 0.4;
  std::vector<int64_t> even;
  for (const auto& clip : embeddings) {
    if (clip.clip_id % 2 == 0) even.push_back(clip.clip_id);
  }
  for (const std::vector<int64_t>* allowed : {static_cast<std::vector<int64_t>*>(nullptr), &even}) {
    std::vector<index::VectorHit> expected;
    for (const auto& clip : embeddings) {
      if (allowed && clip.clip_id % 2 == 1) continue;
      double text = 0, motion = 0;
      for (size_t i = 0; i < kWidth; ++i) text += vectors.text[i] * clip.motion[i];
      for (const size_t part : {2u, 4u, 5u}) {
        for (size_t i = part * kPartWidth; i < (part + 1) * kPartWidth; ++i) {
          motion += vectors.motion_parts[i] * clip.parts[i] / 3;
        }
      }
      expected.push_back({clip.clip_id, static_cast<float>((0.4 * text + motion) / 1.4)});
    }
    std::stable_sort(expected.begin(), expected.end(), [](const auto& left, const auto& right) {
      return left.similarity > right.similarity;
    });
    const auto found = table.nearest(search::linear_query(vectors, query), 50, allowed);
    ASSERT_EQ(found.size(), 50u);
    for (size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].clip_id, expected[i].clip_id) << i;
      EXPECT_NEAR(found[i].similarity, expected[i].similarity, 1e-6);
    }
  }
}

TEST(VectorTable, HoldsTextVectorsOfCaptionedClipsAlone) {
  const index::VectorTable table = index::VectorTable::of_captions(
      {{1, {}, {}, {}}, {2, {}, {}, {1, 0}}, {5, {}, {}, {0.6f, 0.8f}}});
  EXPECT_EQ(table.count(), 2);
  const auto found = table.nearest({{0, 1}, {}}, 10);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].clip_id, 5);
  EXPECT_FLOAT_EQ(found[0].similarity, 0.8f);
  EXPECT_TRUE(index::VectorTable::of_captions({}).nearest({{1, 0}, {}}, 3).empty());
}

TEST(VectorTable, RefusesVectorsOfAnotherWidth) {
  const std::string error = error_of([] {
    index::VectorTable::of_captions({{1, {}, {}, {1, 0}}, {2, {}, {}, {1, 0, 0}}});
  });
  EXPECT_NE(error.find("clip number 2"), std::string::npos) << error;
}

TEST(CutMotion, TakesSecondsAndMakesThemCanonical) {
  const Motion motion = walking_motion(60, 1);
  const Motion piece = search::cut_motion(motion, 1, 2.5);
  EXPECT_EQ(piece.frames, 30);
  EXPECT_NEAR(joint_position(piece, 0, 0).x(), 0, 1e-5);
  EXPECT_NEAR(joint_position(piece, 0, 0).z(), 0, 1e-5);
  EXPECT_EQ(search::cut_motion(motion, 2, std::nullopt).frames, 20);
  EXPECT_EQ(search::cut_motion(motion, 2, 99.0).frames, 20);
  EXPECT_NE(error_of([&] { search::cut_motion(motion, 3, std::nullopt); }), "");
  EXPECT_NE(error_of([&] { search::cut_motion(motion, 2, 1.0); }), "");
  EXPECT_NE(error_of([&] { search::cut_motion(motion, -1, 1.0); }), "");
}

}  // namespace
}  // namespace remomask
