#include "db/merge.h"

#include "db/attribution.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

class MergeTest : public testing::Test {
 protected:
  static int64_t add(db::Database& database, const db::Clip& clip, int seed) {
    return database.add_clip(clip, walking_motion(24, seed));
  }
  static db::Clip grouped_clip(const std::string& name, const std::string& group) {
    db::Clip clip = named_clip(name);
    clip.group = group;
    return clip;
  }
  std::string group_of(const std::string& name) { return here_.clip(*here_.find_name(name)).group; }

  using Pairs = std::vector<std::pair<std::string, std::string>>;
  TestFolder folder_;
  db::Database here_{folder_ / "here", db::OpenMode::create};
  db::Database there_{folder_ / "there", db::OpenMode::create};
};

TEST_F(MergeTest, AttributionsComeAlong) {
  db::Clip ours = named_clip("ours"), shared = named_clip("shared"), other = named_clip("other");
  ours.source = shared.source = "walks";
  other.source = "runs";
  add(here_, ours, 1);
  add(there_, shared, 2);
  const int64_t gone = add(there_, other, 3);
  db::set_attribution(here_, "walks", "by A");
  db::set_attribution(there_, "walks", "by B");
  db::set_attribution(there_, "runs", "by C");
  there_.remove({gone});
  db::merge_database(here_, there_);
  EXPECT_EQ(db::attribution(here_, "walks"), "by A\nby B");
  EXPECT_EQ(db::attribution(here_, "runs"), std::nullopt);
  db::add_attribution(here_, "walks", "by B");
  EXPECT_EQ(db::attribution(here_, "walks"), "by A\nby B");
}

TEST_F(MergeTest, EverythingOfAClipComesAlong) {
  add(here_, named_clip("first"), 1);
  db::Clip clip = named_clip("new");
  clip.source = "elsewhere";
  clip.split = "val";
  clip.licence = "MIT";
  clip.tags = {"good", "short"};
  clip.captions = {"someone hops", "hop"};
  clip.labels = {{"content", "hop"}, {"nested", {{"a", 1}}}};
  const int64_t gone = add(there_, named_clip("gone"), 9);
  there_.remove({gone});
  const int64_t there = add(there_, clip, 2);
  const int64_t second = add(there_, named_clip("second"), 3);
  there_.store_embeddings("r", {{there, {1.f, 2.f}, {3.f}, {4.f}}, {second, {5.f}, {6.f}, {}}});
  there_.store_embeddings("s", {{second, {7.f}, {}, {}}});
  const db::MergeReport report = db::merge_database(here_, there_);
  EXPECT_EQ(report.clips, 2);
  EXPECT_EQ(report.added, 2);
  EXPECT_EQ(report.embeddings, 3);
  EXPECT_TRUE(report.duplicates.empty());
  EXPECT_TRUE(report.renamed.empty());
  EXPECT_TRUE(report.warnings.empty());
  auto all = describe_database(here_);
  all.erase(0);
  EXPECT_EQ(all, describe_database(there_));
  const int64_t id = *here_.find_name("new");
  EXPECT_EQ(here_.embedding("r", id)->motion, (std::vector<float>{1.f, 2.f}));
  EXPECT_EQ(here_.embedding("r", id)->text, (std::vector<float>{4.f}));
  EXPECT_EQ(here_.embedding("s", *here_.find_name("second"))->motion, (std::vector<float>{7.f}));
  EXPECT_FALSE(here_.embedding("s", id));
  EXPECT_EQ(here_.match_captions("hop").at(0).clip_id, id);
  // Once more: all is known.
  const auto before = describe_database(here_);
  const db::MergeReport again = db::merge_database(here_, there_);
  EXPECT_EQ(again.added, 0);
  EXPECT_EQ(again.duplicates, (Pairs{{"new", "new"}, {"second", "second"}}));
  EXPECT_EQ(describe_database(here_), before);
}

TEST_F(MergeTest, DuplicatesAreRefusedAndTakenNamesChange) {
  add(here_, named_clip("a"), 1);
  add(here_, named_clip("b"), 2);
  add(here_, named_clip("b#db2"), 3);
  db::Clip same = named_clip("other name");
  same.captions = {"a person walks.", "of interest"};
  add(there_, same, 1);
  add(there_, named_clip("a"), 4);
  add(there_, named_clip("b"), 5);
  add(there_, named_clip("b#db3"), 6);
  const db::MergeReport report = db::merge_database(here_, there_);
  EXPECT_EQ(report.added, 3);
  EXPECT_EQ(report.duplicates, (Pairs{{"other name", "a"}}));
  // b#db2 is taken here, b#db3 there.
  EXPECT_EQ(report.renamed, (Pairs{{"a", "a#db2"}, {"b", "b#db4"}}));
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("1 caption that 'a' does not have"), std::string::npos);
  EXPECT_EQ(here_.motion(*here_.find_name("b#db4")).positions, walking_motion(24, 5).positions);
  EXPECT_TRUE(here_.find_name("b#db3"));
}

TEST_F(MergeTest, GroupsOfOneNameStayApartUnlessTheyShareAMotionOrALabel) {
  add(here_, grouped_clip("a", "test/walk"), 1);
  add(there_, grouped_clip("b", "test/walk"), 2);
  add(there_, grouped_clip("b2", "test/walk"), 3);
  db::merge_database(here_, there_);
  EXPECT_EQ(group_of("a"), "test/walk");
  EXPECT_EQ(group_of("b"), "test/walk#db2");
  EXPECT_EQ(group_of("b2"), "test/walk#db2");

  db::Database third(folder_ / "third", db::OpenMode::create);
  add(third, grouped_clip("same as b", "another"), 2);
  add(third, grouped_clip("c", "another"), 4);
  db::merge_database(here_, third);
  EXPECT_EQ(group_of("c"), "test/walk#db2");

  db::Database fourth(folder_ / "fourth", db::OpenMode::create),
      fifth(folder_ / "fifth", db::OpenMode::create);
  db::Clip trial = grouped_clip("d", "trial/17");
  trial.labels = {{"trial", "17"}};
  add(fourth, trial, 5);
  trial.name = trial.source_file = "e";
  trial.split = "test";
  add(fifth, trial, 6);
  db::Clip copy = grouped_clip("f", "test/walk");
  copy.labels = {{"duplicate_of", "test/walk"}};
  add(fifth, copy, 7);
  EXPECT_TRUE(db::merge_database(here_, fourth).warnings.empty());
  const db::MergeReport report = db::merge_database(here_, fifth);
  EXPECT_EQ(group_of("d"), "trial/17");
  EXPECT_EQ(group_of("e"), "trial/17");
  EXPECT_EQ(group_of("f"), "test/walk");
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("e: is of split test, but group 'trial/17' was of split train"),
            std::string::npos);
}

TEST_F(MergeTest, NotesOfImportsComeAlongUnlessTheFileIsAnother) {
  add(here_, named_clip("a"), 1);
  here_.note_imported_file("test", "a", "here", "1 clips");
  db::Clip other = named_clip("x");
  other.source_file = "a";
  add(there_, other, 2);
  add(there_, named_clip("b"), 3);
  there_.note_imported_file("test", "a", "there", "1 clips");
  there_.note_imported_file("test", "b", "there", "1 clips");
  db::merge_database(here_, there_);
  EXPECT_TRUE(here_.file_is_imported("test", "a", "here"));
  EXPECT_TRUE(here_.file_is_imported("test", "b", "there"));
  // A changed file "a" replaces the clip that was made of it, not the other.
  EXPECT_EQ(here_.remove_clips("test", "a"), 1);
  EXPECT_FALSE(here_.find_name("a"));
  EXPECT_TRUE(here_.find_name("x"));
}

TEST_F(MergeTest, AllOrNothing) {
  add(here_, named_clip("a"), 1);
  add(there_, named_clip("b"), 2);
  add(there_, named_clip("c"), 3);
  EXPECT_NE(error_of([&] {
              db::merge_database(here_, db::Database(folder_ / "here", db::OpenMode::read_only));
            }).find("with itself"),
            std::string::npos);
  std::stop_source stop;
  Monitor monitor;
  monitor.stop = stop.get_token();
  monitor.progress = [&](const Progress&) { stop.request_stop(); };
  const int64_t generation = here_.generation();
  EXPECT_THROW(db::merge_database(here_, there_, monitor), Interrupted);
  EXPECT_EQ(here_.clip_count(), 1);
  EXPECT_EQ(here_.generation(), generation);
  EXPECT_EQ(db::merge_database(here_, there_).added, 2);
}

}  // namespace
}  // namespace remomask
