#include "index/search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/db/db_test_tools.h"
#include "tests/index/index_test_tools.h"

namespace remomask {
namespace {

/// Clip i lies at the angle i * 0.1 from the query (1, 0): the order is known.
/// Clips 0..19 are windows of one file, each with its mirror twin behind it.
class SearchDatabase : public ::testing::Test {
 protected:
  void SetUp() override {
    database_.emplace(folder_ / "motions.sqlite", OpenMode::create);
    std::vector<float> vectors;
    for (int i = 0; i < 30; ++i) {
      Clip clip = named_clip("clip" + std::to_string(i));
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
    index_.emplace(VectorIndex::build(*database_, "retriever"));
  }

  std::vector<std::string> names(const SearchOptions& options) {
    std::vector<std::string> found;
    const auto hits = search_database(*database_, *index_, query_, 1, options).front();
    for (size_t i = 0; i < hits.size(); ++i) {
      EXPECT_EQ(hits[i].rank, static_cast<int>(i) + 1);
      found.push_back(hits[i].clip.name);
    }
    return found;
  }

  TestFolder folder_;
  std::optional<Database> database_;
  std::optional<VectorIndex> index_;
  const float query_[2] = {1.f, 0.f};
};

using Names = std::vector<std::string>;

SearchOptions best(int k, Collapse collapse = Collapse::none) {
  SearchOptions options;
  options.k = k;
  options.collapse = collapse;
  return options;
}

TEST_F(SearchDatabase, ReturnsClipsWithTheirFields) {
  const auto hits = search_database(*database_, *index_, query_, 1, best(3)).front();
  ASSERT_EQ(hits.size(), 3u);
  EXPECT_EQ(hits[1].clip.name, "clip1");
  EXPECT_EQ(hits[1].clip.captions.size(), 2u);
  EXPECT_NEAR(hits[1].similarity, std::cos(0.1), 1e-6);
}

TEST_F(SearchDatabase, CollapsesMirrorTwins) {
  EXPECT_EQ(names(best(3, Collapse::mirrors)), (Names{"clip0", "clip2", "clip4"}));
}

TEST_F(SearchDatabase, CollapsesGroupsAndLooksFurther) {
  // 20 clips of one group come first: three hits need 22 neighbours.
  EXPECT_EQ(names(best(3, Collapse::groups)), (Names{"clip0", "clip20", "clip21"}));
  EXPECT_EQ(names(best(30, Collapse::groups)).size(), 11u);
}

TEST_F(SearchDatabase, FiltersBeforeItCollapses) {
  SearchOptions options = best(3, Collapse::groups);
  options.filter.splits = {"val"};
  EXPECT_EQ(names(options), (Names{"clip1", "clip21", "clip23"}));
}

TEST_F(SearchDatabase, AnswersEveryQueryOfABatch) {
  const float queries[4] = {1.f, 0.f, static_cast<float>(std::cos(2.9)),
                            static_cast<float>(std::sin(2.9))};
  const auto hits = search_database(*database_, *index_, queries, 2, best(2));
  ASSERT_EQ(hits.size(), 2u);
  EXPECT_EQ(hits[0][0].clip.name, "clip0");
  EXPECT_EQ(hits[1][0].clip.name, "clip29");
}

TEST_F(SearchDatabase, AnotherProcessWritesBesideAnOpenIndex) {
  {
    Database writer(database_->path(), OpenMode::read_write);
    add_test_clip(writer, named_clip("one more"));
    writer.remove({*writer.find_name("clip0"), *writer.find_name("clip2")});
  }
  // What was lost is left out, and the search looks further for k clips.
  EXPECT_EQ(names(best(3)), (Names{"clip1", "clip3", "clip4"}));
  SearchOptions options = best(2);
  options.filter.splits = {"train"};
  EXPECT_EQ(names(options), (Names{"clip4", "clip6"}));
  EXPECT_EQ(names(best(30)).size(), 28u);
  index_->follow(*database_);
  EXPECT_EQ(names(best(3)), (Names{"clip1", "clip3", "clip4"}));
}

TEST_F(SearchDatabase, RefusesTheIndexOfAnotherDatabase) {
  const Database other(folder_ / "other.sqlite", OpenMode::create);
  EXPECT_NE(error_of([&] { search_database(other, *index_, query_, 1, best(1)); }).find("another"),
            std::string::npos);
}

}  // namespace
}  // namespace remomask
