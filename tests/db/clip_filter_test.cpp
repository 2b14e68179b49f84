#include "db/clip_filter.h"

#include <gtest/gtest.h>

#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

std::vector<db::Clip> example_clips() {
  std::vector<db::Clip> clips(5);
  for (size_t i = 0; i < clips.size(); ++i) {
    clips[i].id = static_cast<int64_t>(i) + 1;
    clips[i].frames = 40 * (static_cast<int>(i) + 1);  // 2, 4, ... 10 seconds
    clips[i].split = i < 3 ? "train" : "test";
    clips[i].group = i < 2 ? "one" : "other" + std::to_string(i);
  }
  clips[1].mirrored = true;
  clips[0].labels = {{"content", "walk"}, {"actions", {"walk", "turn left"}}};
  clips[1].labels = {{"content", "run"}, {"measured", {{"turn", 0.5}, {"far", true}}}};
  clips[2].labels = {{"content", "walk"}, {"measured", {{"turn", -1}}}};
  clips[3].labels = {{"measured.turn", "dotted"}, {"actions", {"run"}}};
  return clips;
}

std::vector<int64_t> ids_with(const std::string& condition) {
  ClipFilter filter;
  filter.labels = {db::parse_label_condition(condition)};
  return db::matching_clips(example_clips(), filter);
}

using Ids = std::vector<int64_t>;

TEST(ClipFilter, EmptyFilterTakesAll) {
  EXPECT_TRUE(ClipFilter().empty());
  EXPECT_EQ(db::matching_clips(example_clips(), {}), (Ids{1, 2, 3, 4, 5}));
}

TEST(ClipFilter, LabelsTextListAndNested) {
  EXPECT_EQ(ids_with("content=walk"), (Ids{1, 3}));
  EXPECT_EQ(ids_with("actions=turn left"), (Ids{1}));
  EXPECT_EQ(ids_with("actions=run"), (Ids{4}));
  EXPECT_EQ(ids_with("measured.turn=0.50"), (Ids{2}));
  EXPECT_EQ(ids_with("measured.turn=-1"), (Ids{3}));
  EXPECT_EQ(ids_with("measured.turn=dotted"), (Ids{4}));
  EXPECT_EQ(ids_with("measured.far=true"), (Ids{2}));
  EXPECT_EQ(error_of([] { ids_with("content=walking"); }),
            "no clip has the label content=walking; values that begin alike: walk");
  EXPECT_NE(error_of([] { ids_with("content="); }).find("check how it is written"),
            std::string::npos);
  EXPECT_NE(error_of([] { ids_with("measured.turn=3"); }), "");
}

TEST(ClipFilter, AllLabelConditionsMustHold) {
  ClipFilter filter;
  filter.labels = {{"content", "walk"}, {"actions", "walk"}};
  EXPECT_EQ(db::matching_clips(example_clips(), filter), (Ids{1}));
}

TEST(ClipFilter, SplitsAndLengths) {
  ClipFilter filter;
  filter.splits = {"test", "val"};
  EXPECT_EQ(db::matching_clips(example_clips(), filter), (Ids{4, 5}));
  filter = {};
  filter.min_seconds = 4;
  filter.max_seconds = 8;
  EXPECT_EQ(db::matching_clips(example_clips(), filter), (Ids{2, 3, 4}));
  filter.max_seconds = 7.9;
  EXPECT_EQ(db::matching_clips(example_clips(), filter), (Ids{2, 3}));
}

TEST(ClipFilter, TagsLicencesAndSpeed) {
  auto clips = example_clips();
  clips[0].tags = {"good", "new"};
  clips[1].tags = {"good"};
  clips[2].licence = "MIT";
  clips[3].licence = "CC0";
  for (size_t i = 0; i < clips.size(); ++i) clips[i].speed = 0.5 * static_cast<double>(i);
  ClipFilter filter;
  filter.tags = {"good"};
  EXPECT_FALSE(filter.empty());
  EXPECT_EQ(db::matching_clips(clips, filter), (Ids{1, 2}));
  filter.tags = {"good", "new"};
  EXPECT_EQ(db::matching_clips(clips, filter), (Ids{1}));
  filter = {};
  filter.licences = {"MIT", "CC0"};
  EXPECT_FALSE(filter.empty());
  EXPECT_EQ(db::matching_clips(clips, filter), (Ids{3, 4}));
  filter = {};
  filter.min_speed = 0.5;
  EXPECT_FALSE(filter.empty());
  EXPECT_EQ(db::matching_clips(clips, filter), (Ids{2, 3, 4, 5}));
  filter.max_speed = 1.5;
  EXPECT_EQ(db::matching_clips(clips, filter), (Ids{2, 3, 4}));
  filter.max_speed = 0.4;
  EXPECT_NE(error_of([&] { db::matching_clips(clips, filter); }).find("0.5 m/s"),
            std::string::npos);
  filter = {};
  filter.tags = {"goood"};
  EXPECT_NE(error_of([&] { db::matching_clips(clips, filter); }).find("'goood'"),
            std::string::npos);
  filter = {};
  filter.licences = {"GPL"};
  EXPECT_NE(error_of([&] { db::matching_clips(clips, filter); }).find("'GPL'"), std::string::npos);
}

TEST(ClipFilter, CaptionsOfADatabase) {
  TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  std::vector<int64_t> ids;
  for (const char* caption : {"a person walks", "someone runs", "a person runs left"}) {
    db::Clip clip = named_clip(caption);
    clip.captions = {caption};
    clip.split = ids.empty() ? "test" : "train";
    ids.push_back(database.add_clip(clip, walking_motion(20, static_cast<int>(ids.size()))));
  }
  ClipFilter filter;
  EXPECT_EQ(db::matching_clips(database, filter), ids);
  filter.caption_query = "running";
  EXPECT_FALSE(filter.empty());
  EXPECT_EQ(db::matching_clips(database, filter), (Ids{ids[1], ids[2]}));
  filter.caption_query = "person";
  filter.splits = {"train"};
  EXPECT_EQ(db::matching_clips(database, filter), (Ids{ids[2]}));
  EXPECT_THROW(db::matching_clips(database.clips(), filter), Error);
  filter.caption_query = "person AND";
  EXPECT_THROW(db::matching_clips(database, filter), Error);
}

TEST(ClipFilter, Exclusions) {
  ClipFilter filter;
  filter.excluded_groups = {"one"};
  filter.excluded_clips = {5};
  EXPECT_FALSE(filter.empty());
  EXPECT_EQ(db::matching_clips(example_clips(), filter), (Ids{3, 4}));
  filter = {};
  filter.exclude_mirrored = true;
  EXPECT_EQ(db::matching_clips(example_clips(), filter), (Ids{1, 3, 4, 5}));
}

TEST(ClipFilter, RefusesMistakes) {
  ClipFilter filter;
  filter.splits = {"tests"};
  EXPECT_NE(error_of([&] { db::matching_clips(example_clips(), filter); }).find("'tests'"),
            std::string::npos);
  filter = {};
  filter.min_seconds = 3;
  filter.max_seconds = 2;
  EXPECT_NE(error_of([&] { db::matching_clips(example_clips(), filter); }), "");
  EXPECT_NE(error_of([] { ids_with("contents=walk"); }).find("'contents'"), std::string::npos);
  EXPECT_NE(error_of([] { db::parse_label_condition("walk"); }).find("key=value"),
            std::string::npos);
  EXPECT_NE(error_of([] { db::parse_label_condition("=walk"); }), "");
  EXPECT_EQ(db::parse_label_condition("a=b=c").value, "b=c");
}

}  // namespace
}  // namespace remomask
