#include <limits>

#include "db/clip_speed.h"
#include "db/database.h"
#include "db/database_impl.h"
#include "db/sqlite.h"
#include "db/transaction.h"
#include "motion/vector.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

class ClipChangesTest : public testing::Test {
 protected:
  void SetUp() override {
    for (int i = 0; i < 3; ++i) {
      ids_.push_back(
          database_.add_clip(named_clip(std::string(1, 'a' + i)), walking_motion(30, i)));
    }
    database_.store_embeddings("r", {embedding(0), embedding(1), embedding(2)});
    database_.store_embeddings("s", {embedding(0), embedding(1)});
  }
  db::ClipEmbedding embedding(size_t clip, float value = 1.f) const {
    return {ids_[clip], {value, static_cast<float>(clip)}, {value}, {value}};
  }
  bool change(size_t clip, const db::ClipChanges& changes) {
    return database_.update_clip(ids_[clip], changes);
  }

  using Ids = std::vector<int64_t>;
  TestFolder folder_;
  db::Database database_{folder_ / "d", db::OpenMode::create};
  Ids ids_;
};

TEST_F(ClipChangesTest, WhatIsNotGivenStays) {
  const db::Clip before = database_.clip(ids_[0]);
  const int64_t generation = database_.generation();
  db::ClipChanges changes;
  changes.split = "val";
  changes.licence = "MIT";
  changes.tags = {"new", "good", "new"};
  changes.labels = nlohmann::json{{"content", "run"}, {"actions", nullptr}, {"count", 2}};
  EXPECT_TRUE(change(0, changes));
  EXPECT_EQ(database_.generation(), generation + 1);
  const db::Clip after = database_.clip(ids_[0]);
  EXPECT_EQ(after.split, "val");
  EXPECT_EQ(after.licence, "MIT");
  EXPECT_EQ(after.tags, (std::vector<std::string>{"good", "new"}));
  EXPECT_EQ(after.labels, (nlohmann::json{{"content", "run"}, {"count", 2}}));
  EXPECT_EQ(after.captions, before.captions);
  EXPECT_EQ(database_.clips().at(0).tags, after.tags);
  EXPECT_TRUE(database_.clips().at(1).tags.empty());
  EXPECT_EQ(database_.embedded_clips("r"), ids_);
  EXPECT_EQ(database_.clip(ids_[1]).split, "train");
  // The same once more changes nothing: the search index stays up to date.
  EXPECT_FALSE(change(0, changes));
  EXPECT_EQ(database_.generation(), generation + 1);
}

TEST_F(ClipChangesTest, NewCaptionsTakeTheVectorsOfTheClipWithThem) {
  db::ClipChanges changes;
  changes.captions = database_.clip(ids_[1]).captions;
  EXPECT_FALSE(change(1, changes));
  EXPECT_EQ(database_.embedded_clips("r"), ids_);
  changes.captions = {"someone hops."};
  EXPECT_TRUE(change(1, changes));
  EXPECT_EQ(database_.clip(ids_[1]).captions, *changes.captions);
  EXPECT_EQ(database_.embedded_clips("r"), (Ids{ids_[0], ids_[2]}));
  EXPECT_EQ(database_.embedded_clips("s"), (Ids{ids_[0]}));
}

TEST_F(ClipChangesTest, NothingIsStoredOfChangesThatMakeNoSense) {
  const auto before = describe_database(database_);
  const int64_t generation = database_.generation();
  db::ClipChanges bad_split, bad_labels, bad_tag;
  bad_split.captions = {"new"};
  bad_split.split = "training";
  bad_labels.licence = "MIT";
  bad_labels.labels = nlohmann::json::array();
  bad_tag.licence = "MIT";
  for (const char* tag : {"", " a", "a ", "a\nb"}) {
    bad_tag.tags = {tag};
    EXPECT_THROW(change(0, bad_tag), Error) << tag;
  }
  EXPECT_THROW(change(0, bad_split), Error);
  EXPECT_THROW(change(0, bad_labels), Error);
  EXPECT_THROW(database_.update_clip(ids_[2] + 1, {}), Error);
  EXPECT_EQ(describe_database(database_), before);
  EXPECT_EQ(database_.generation(), generation);
  EXPECT_EQ(database_.embedded_clips("r"), ids_);
}

TEST_F(ClipChangesTest, RemovedClipsTakeTagsAndVectorsAndTheirIdsNeverReturn) {
  db::ClipChanges changes;
  changes.tags = {"x"};
  change(2, changes);
  const int64_t generation = database_.generation();
  EXPECT_THROW(database_.remove({ids_[0], ids_[2] + 1}), Error);
  EXPECT_EQ(database_.clip_count(), 3);
  EXPECT_EQ(database_.generation(), generation);
  database_.remove({ids_[0], ids_[2]});
  EXPECT_EQ(database_.generation(), generation + 1);
  EXPECT_EQ(database_.embedded_clips("r"), (Ids{ids_[1]}));
  const db::SqliteConnection connection(folder_ / "d", db::SqliteMode::read_only);
  EXPECT_EQ(connection.integer("SELECT count(*) FROM tag"), 0);
  EXPECT_GT(database_.add_clip(named_clip("c"), walking_motion(30, 2)), ids_[2]);
}

TEST_F(ClipChangesTest, AddedVectorsLeaveThoseOfOtherClips) {
  const int64_t generation = database_.generation();
  database_.add_embeddings("s", {embedding(2, 7.f), embedding(0, 8.f)});
  EXPECT_EQ(database_.generation(), generation + 1);
  EXPECT_EQ(database_.embedded_clips("s"), ids_);
  const auto some = database_.embeddings("s", {ids_[2], ids_[0]});
  ASSERT_EQ(some.size(), 2u);
  EXPECT_EQ(some[0].clip_id, ids_[2]);
  EXPECT_EQ(some[0].motion, (std::vector<float>{7.f, 2.f}));
  EXPECT_EQ(some[1].text, (std::vector<float>{8.f}));
  EXPECT_EQ(database_.embedding("s", ids_[1])->parts, (std::vector<float>{1.f}));
  EXPECT_EQ(database_.embedding("r", ids_[0])->parts, (std::vector<float>{1.f}));
  EXPECT_THROW(database_.embeddings("s", {ids_[2] + 1}), Error);
  EXPECT_THROW(database_.add_embeddings("s", {{ids_[2] + 1, {1.f}, {}, {}}}), Error);
  EXPECT_EQ(database_.retrievers(), (std::vector<std::string>{"r", "s"}));
}

TEST_F(ClipChangesTest, EmbeddedClipsReadsAnIndexAlone) {
  const db::SqliteConnection connection(folder_ / "d", db::SqliteMode::read_only);
  db::SqliteStatement plan(connection,
                           (std::string("EXPLAIN QUERY PLAN ") + db::kEmbeddedClips).c_str());
  std::string text;
  while (plan.step()) text += plan.text(3) + "; ";
  EXPECT_NE(text.find("USING COVERING INDEX embedding_by_retriever"), std::string::npos) << text;
  EXPECT_EQ(text.find("TEMP B-TREE"), std::string::npos) << text;
}

TEST_F(ClipChangesTest, TheLogOfVectorsSaysWhatChangedSince) {
  const int64_t start = database_.generation();
  const auto changes = [&](int64_t since, const std::string& retriever = "r") {
    const auto found = database_.embedding_changes(retriever, since);
    return std::pair(found->present, found->absent);
  };
  EXPECT_EQ(changes(start), std::pair(Ids{}, Ids{}));
  EXPECT_EQ(changes(0).first, database_.embedded_clips("r"));
  db::ClipChanges captions, tags;
  captions.captions = {"someone waves."};
  tags.tags = {"good"};
  database_.update_clip(ids_[1], tags);  // no vector changes
  EXPECT_EQ(changes(start), std::pair(Ids{}, Ids{}));
  database_.update_clip(ids_[1], captions);
  const int64_t dropped = database_.generation();
  EXPECT_EQ(changes(start), std::pair(Ids{}, Ids{ids_[1]}));
  database_.add_embeddings("r", {{ids_[1], {0.f, 1.f}, {1.f}, {}}});
  database_.remove({ids_[2]});  // takes its vectors with it
  EXPECT_EQ(changes(start), std::pair(Ids{ids_[1]}, Ids{ids_[2]}));
  EXPECT_EQ(changes(dropped), std::pair(Ids{ids_[1]}, Ids{ids_[2]}));
  EXPECT_EQ(changes(database_.generation()), std::pair(Ids{}, Ids{}));
  EXPECT_EQ(changes(0, "unknown"), std::pair(Ids{}, Ids{}));
  {
    const db::Transaction undone(database_);
    database_.remove({ids_[0]});
  }
  EXPECT_EQ(changes(start), std::pair(Ids{ids_[1]}, Ids{ids_[2]}));
}

TEST_F(ClipChangesTest, TheLogOfVectorsIsReadByIndexesAlone) {
  const db::SqliteConnection connection(folder_ / "d", db::SqliteMode::read_only);
  db::SqliteStatement plan(connection,
                           (std::string("EXPLAIN QUERY PLAN ") + db::kEmbeddingChanges).c_str());
  std::string text;
  while (plan.step()) text += plan.text(3) + "; ";
  EXPECT_NE(text.find("(retriever_hash=? AND generation>?)"), std::string::npos) << text;
  EXPECT_NE(text.find("SEARCH embedding USING COVERING INDEX"), std::string::npos) << text;
  EXPECT_EQ(text.find("SCAN"), std::string::npos) << text;
}

TEST_F(ClipChangesTest, MotionVectorsAlone) {
  database_.add_embeddings("s", {{ids_[0], {1.f, 2.f}, {9.f}, {}}, {ids_[2], {3.f, 4.f}, {}, {}}});
  EXPECT_EQ(database_.motion_vectors("s", {ids_[2], ids_[0]}, 2),
            (std::vector<float>{3.f, 4.f, 1.f, 2.f}));
  EXPECT_TRUE(database_.motion_vectors("s", {}, 2).empty());
  EXPECT_NE(error_of([&] { database_.motion_vectors("r", {ids_[2] + 1}, 2); }).find("no vectors"),
            std::string::npos);
  EXPECT_NE(error_of([&] { database_.motion_vectors("s", {ids_[0]}, 3); }).find("8 bytes instead"),
            std::string::npos);
}

TEST_F(ClipChangesTest, CopiesThatAreChangedApartHaveOtherWriters) {
  const int64_t common = database_.generation();
  const std::string writer = database_.writer_of(common);
  EXPECT_EQ(writer.size(), 36u);
  EXPECT_EQ(database_.writer_of(0), "");
  run_sql(folder_ / "d", ("VACUUM INTO '" + folder_ / "copy" + "'").c_str());
  db::Database copy(folder_ / "copy", db::OpenMode::read_write);
  database_.remove({ids_[0]});
  copy.remove({ids_[1]});
  copy.remove({ids_[2]});
  EXPECT_EQ(copy.uuid(), database_.uuid());
  EXPECT_EQ(copy.generation(), database_.generation() + 1);
  EXPECT_EQ(copy.writer_of(common), writer);
  // The object here went on as it was: no new token, that of the copy tells.
  EXPECT_EQ(database_.writer_of(common + 1), writer);
  EXPECT_NE(copy.writer_of(common + 1), writer);
  EXPECT_EQ(copy.writer_of(common + 2), copy.writer_of(common + 1));
  {
    db::Database second(folder_ / "d", db::OpenMode::read_write);
    second.remove({ids_[1]});
  }
  EXPECT_NE(database_.writer_of(common + 2), writer);
  EXPECT_EQ(database_.writer_of(common + 1), writer);
}

TEST_F(ClipChangesTest, SpeedIsThePathOverTheGroundInMetresASecond) {
  Motion motion(3, 22);
  set_joint_position(motion, 1, 0, Vec3(0.3, 5, 0.4));  // half a metre in a twentieth of a second
  set_joint_position(motion, 2, 0, Vec3(0.3, 9, 0.4));
  EXPECT_NEAR(db::mean_root_speed(motion), 5.0, 1e-6);
  EXPECT_EQ(db::mean_root_speed(Motion(1, 22)), 0);
  const int64_t id = database_.add_clip(named_clip("speed"), motion);
  EXPECT_NEAR(database_.clip(id).speed, 5.0, 1e-6);
}

TEST_F(ClipChangesTest, SnapshotSeesOneStateWhileAnotherProgramWrites) {
  const db::Database reader(folder_ / "d", db::OpenMode::read_only);
  {
    const db::ReadSnapshot snapshot(reader);
    const db::ReadSnapshot inner(reader);
    const int64_t generation = reader.generation();
    database_.remove({ids_[0]});
    EXPECT_EQ(reader.generation(), generation);
    EXPECT_EQ(reader.clips().size(), 3u);
    EXPECT_EQ(reader.clip(ids_[0]).name, "a");
    EXPECT_EQ(reader.embedded_clips("r"), ids_);
  }
  EXPECT_EQ(reader.clips().size(), 2u);
  {
    const db::ReadSnapshot snapshot(database_);
    EXPECT_THROW(database_.remove({ids_[1]}), Error);
    EXPECT_EQ(database_.clip_count(), 2);
  }
  database_.remove({ids_[1]});
  EXPECT_EQ(database_.clip_count(), 1);
}

}  // namespace
}  // namespace remomask
