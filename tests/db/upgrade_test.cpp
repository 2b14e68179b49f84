#include <filesystem>

#include "db/check.h"
#include "db/database.h"
#include "db/sqlite.h"
#include "db/upgrade.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

// Takes away what versions 5 and 6 added.
constexpr const char* kDowngradeTo4 = R"sql(
DROP TRIGGER caption_replaces_guess; DROP TABLE guessed_caption;
DROP TABLE caption_vector;
PRAGMA user_version = 4;
)sql";

// And version 4.
constexpr const char* kDowngradeTo3 = R"sql(
ALTER TABLE clip DROP COLUMN checksum;
ALTER TABLE motion DROP COLUMN checksum;
ALTER TABLE embedding DROP COLUMN checksum;
PRAGMA user_version = 3;
)sql";

// And version 3.
constexpr const char* kDowngradeTo2 = R"sql(
DROP TABLE embedding_change; DROP TABLE writer;
DROP TRIGGER embedding_inserted; DROP TRIGGER embedding_deleted;
DELETE FROM fact WHERE key = 'changes_since';
PRAGMA user_version = 2;
)sql";

// And version 2.
constexpr const char* kDowngradeTo1 = R"sql(
DROP TRIGGER caption_inserted; DROP TRIGGER caption_deleted; DROP TRIGGER caption_updated;
DROP TABLE caption_words; DROP VIEW caption_row; DROP TABLE tag;
DROP INDEX embedding_by_retriever;
ALTER TABLE clip DROP COLUMN speed;
PRAGMA user_version = 1;
)sql";

std::string schema_of(const std::string& path) {
  const db::SqliteConnection connection(path, db::SqliteMode::read_only);
  db::SqliteStatement rows(connection, "SELECT name, sql FROM sqlite_master ORDER BY name");
  std::string schema;
  while (rows.step()) schema += rows.text(0) + ": " + rows.text(1) + "\n";
  return schema;
}

class UpgradeTest : public testing::Test {
 protected:
  void SetUp() override {
    db::Database database(path_, db::OpenMode::create);
    const int64_t a = database.add_clip(named_clip("a"), walking_motion(40, 1));
    db::Clip other = named_clip("b");
    other.captions = {"someone jumps."};
    database.add_clip(other, walking_motion(30, 6));
    database.store_embeddings("r", {{a, {1.f}, {2.f}, {3.f}}});
    before_ = describe_database(database);
    speed_ = database.clip(a).speed;
    generation_ = database.generation();
    uuid_ = database.uuid();
  }

  void downgrade(int version) {
    run_sql(path_, kDowngradeTo4);
    if (version <= 3) run_sql(path_, kDowngradeTo3);
    if (version <= 2) run_sql(path_, kDowngradeTo2);
    if (version == 1) run_sql(path_, kDowngradeTo1);
  }

  TestFolder folder_;
  std::string path_ = folder_ / "d";
  nlohmann::json before_;
  double speed_ = 0;
  int64_t generation_ = 0;
  std::string uuid_;
};

TEST_F(UpgradeTest, AnOldFileBecomesWhatANewOneIs) {
  const std::string schema = schema_of(path_);
  downgrade(1);
  ASSERT_NE(schema_of(path_), schema);
  const db::Database database(path_, db::OpenMode::read_write);
  EXPECT_EQ(schema_of(path_), schema);
  EXPECT_EQ(describe_database(database), before_);
  EXPECT_EQ(database.clip(*database.find_name("a")).speed, speed_);
  EXPECT_GT(speed_, 0.1);
  EXPECT_EQ(database.generation(), generation_);
  EXPECT_EQ(database.uuid(), uuid_);
  EXPECT_EQ(database.embeddings("r").at(0).text, (std::vector<float>{3.f}));
  EXPECT_EQ(database.match_captions("walk").at(0).clip_id, *database.find_name("a"));
  EXPECT_EQ(database.match_captions("jump").at(0).clip_id, *database.find_name("b"));
}

TEST_F(UpgradeTest, ReadingAnOldFileSaysHowToUpgradeAndChangesNothing) {
  downgrade(1);
  const std::string schema = schema_of(path_);
  const std::string message = error_of([&] { db::Database(path_, db::OpenMode::read_only); });
  EXPECT_NE(message.find("older version"), std::string::npos) << message;
  EXPECT_NE(message.find("remomask db upgrade " + path_), std::string::npos) << message;
  EXPECT_EQ(schema_of(path_), schema);
}

TEST_F(UpgradeTest, Format2IsReadAsItIs) {
  downgrade(2);
  const std::string schema = schema_of(path_);
  const db::Database database(path_, db::OpenMode::read_only);
  EXPECT_EQ(describe_database(database), before_);
  EXPECT_EQ(database.embedded_clips("r").size(), 1u);
  EXPECT_FALSE(database.embedding_changes("r", 0));
  EXPECT_EQ(database.writer_of(database.generation()), "");
  EXPECT_EQ(schema_of(path_), schema);
}

TEST_F(UpgradeTest, Format3IsReadAsItIsAndItsUpgradeAddsChecksums) {
  downgrade(3);
  const std::string schema = schema_of(path_);
  {
    const db::Database database(path_, db::OpenMode::read_only);
    EXPECT_EQ(describe_database(database), before_);
    EXPECT_EQ(database.embeddings("r").size(), 1u);
    EXPECT_FALSE(db::check_database(path_).has_checksums);
    EXPECT_EQ(schema_of(path_), schema);
  }
  EXPECT_EQ(db::upgrade_database(path_).version_before, 3);
  EXPECT_TRUE(db::check_database(path_).has_checksums);
  const db::SqliteConnection connection(path_, db::SqliteMode::read_only);
  for (const char* table : {"clip", "motion", "embedding"}) {
    const std::string sql = std::string("SELECT count(*) FROM ") + table + " WHERE checksum = ''";
    EXPECT_EQ(connection.integer(sql.c_str()), 0) << table;
  }
  EXPECT_EQ(describe_database(db::Database(path_, db::OpenMode::read_only)), before_);
}

TEST_F(UpgradeTest, TheLogOfChangesBeginsWithTheUpgrade) {
  downgrade(2);
  db::Database database(path_, db::OpenMode::read_write);
  EXPECT_FALSE(database.embedding_changes("r", generation_ - 1));
  EXPECT_EQ(database.writer_of(generation_), "");
  ASSERT_TRUE(database.embedding_changes("r", generation_));
  EXPECT_TRUE(database.embedding_changes("r", generation_)->present.empty());
  const int64_t b = *database.find_name("b");
  database.add_embeddings("r", {{b, {1.f}, {2.f}, {3.f}}});
  EXPECT_EQ(database.embedding_changes("r", generation_)->present, (std::vector<int64_t>{b}));
  EXPECT_NE(database.writer_of(database.generation()), "");
}

TEST_F(UpgradeTest, AFailingUpgradeLeavesTheOldFile) {
  downgrade(1);
  run_sql(path_, "UPDATE motion SET positions = x'00000000' WHERE clip_id = 2");
  const std::string schema = schema_of(path_);
  const std::string message = error_of([&] { db::Database(path_, db::OpenMode::read_write); });
  EXPECT_NE(message.find("clip number 2 is cut off"), std::string::npos) << message;
  EXPECT_EQ(schema_of(path_), schema);
  EXPECT_NE(error_of([&] { db::Database(path_, db::OpenMode::read_only); }).find("older"),
            std::string::npos);
}

TEST_F(UpgradeTest, CommandReportsAndGivesPagesBack) {
  downgrade(1);
  run_sql(path_, "CREATE TABLE t (x); INSERT INTO t VALUES (zeroblob(1000000)); DROP TABLE t");
  const db::UpgradeReport first = db::upgrade_database(path_);
  EXPECT_EQ(first.version_before, 1);
  EXPECT_EQ(first.version, 7);
  EXPECT_LT(first.bytes + 900000, first.bytes_before);
  const db::UpgradeReport second = db::upgrade_database(path_);
  EXPECT_EQ(second.version_before, 7);
  const db::Database database(path_, db::OpenMode::read_only);
  EXPECT_EQ(describe_database(database), before_);
  EXPECT_EQ(database.generation(), generation_);
}

}  // namespace
}  // namespace remomask
