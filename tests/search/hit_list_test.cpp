#include "search/hit_list.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>

#include "db/clip_filter.h"
#include "tests/db/db_test_tools.h"
#include "tests/index/index_test_tools.h"

namespace remomask {
namespace {

using Names = std::vector<std::string>;

/// Clip i lies at the angle i * 0.1 from the query (1, 0): the order is known.
/// Clips 0..19 are windows of one file, each with its mirror twin behind it.
class HitListTest : public ::testing::Test {
 protected:
  void SetUp() override {
    database_.emplace(folder_ / "motions.sqlite", db::OpenMode::create);
    std::vector<float> vectors;
    for (int i = 0; i < 30; ++i) {
      db::Clip clip = named_clip("clip" + std::to_string(i));
      if (i < 20) {
        clip.group = "test/file";
        clip.start_frame = 100 * (i / 2);
        clip.mirrored = i % 2 == 1;
      }
      clip.split = i % 2 == 0 ? "train" : "val";
      add_test_clip(*database_, clip);
      vectors.push_back(static_cast<float>(std::cos(0.1 * i)));
      vectors.push_back(static_cast<float>(std::sin(0.1 * i)));
    }
    store_motion_vectors(*database_, "retriever", vectors, 2);
    scene_.state = std::make_shared<search::SearchState>(
        index::VectorIndex::build(*database_, "retriever"), database_->clips());
  }

  std::vector<MotionHit> hits(int k, bool grouped) const {
    SearchQuery query;
    query.k = k;
    query.grouped = grouped;
    return search::collect_hits(scene_, query, {{1.f, 0.f}, {}}).hits;
  }
  Names names(int k, bool grouped) const {
    Names found;
    for (const MotionHit& hit : hits(k, grouped)) {
      found.push_back(hit.clip.name);
      EXPECT_EQ(hit.rank, static_cast<int>(found.size()));
    }
    return found;
  }

  TestFolder folder_;
  std::optional<db::Database> database_;
  search::SearchScene scene_;
};

TEST_F(HitListTest, ReturnsClipsWithTheirFields) {
  const auto found = hits(3, false);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[1].clip.name, "clip1");
  EXPECT_EQ(found[1].clip.captions.size(), 2u);
  EXPECT_NEAR(found[1].similarity, std::cos(0.1), 1e-6);
  EXPECT_FALSE(found[1].probability);
}

TEST_F(HitListTest, GroupsAndLooksFurther) {
  // 20 clips of one group come first: three hits need 22 neighbours.
  EXPECT_EQ(names(3, true), (Names{"clip0", "clip20", "clip21"}));
  EXPECT_EQ(names(30, true).size(), 11u);
  EXPECT_EQ(names(3, false), (Names{"clip0", "clip1", "clip2"}));
  EXPECT_EQ(names(40, false).size(), 30u);
}

TEST_F(HitListTest, FiltersBeforeItGroups) {
  ClipFilter filter;
  filter.splits = {"val"};
  scene_.allowed = db::matching_clips(*database_, filter);
  EXPECT_EQ(names(3, true), (Names{"clip1", "clip21", "clip23"}));
  EXPECT_EQ(hits(3, true)[0].folded, 9);
}

}  // namespace
}  // namespace remomask
