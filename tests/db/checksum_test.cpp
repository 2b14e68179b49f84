#include <gtest/gtest.h>

#include "db/check.h"
#include "db/database.h"
#include "db/transaction.h"
#include "remomask/error.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

class ChecksumTest : public testing::Test {
 protected:
  void SetUp() override {
    db::Database database(path_, db::OpenMode::create);
    db::Clip clip = named_clip("a");
    clip.captions = {"a person walks."};
    clip.tags = {"best"};
    id_ = database.add_clip(clip, walking_motion(30, 1));
    database.store_embeddings("r", {{id_, {0.6f, 0.8f}, {0.5f}, {1.f, 0.f}}});
  }

  std::string damage_found_by_check() {
    const db::CheckReport report = db::check_database(path_);
    return report.defects.empty() ? "" : report.defects[0].clip + ": " + report.defects[0].what;
  }

  TestFolder folder_;
  std::string path_ = folder_ / "d";
  int64_t id_ = 0;
};

// Changes that leave every table in order: only the checksum can tell.
TEST_F(ChecksumTest, ChangedTextsAreNamedByCheckAndByReading) {
  const char* changes[] = {
      "UPDATE caption SET text = 'a person waits.'",
      "UPDATE tag SET tag = 'bess'",
      "UPDATE clip SET licence = licence || 'x'",
      "UPDATE clip SET labels = '{\"content\":\"x\"}'",
      "UPDATE clip SET split = 'test'",
      "UPDATE clip SET start_frame = 7",
  };
  for (const char* sql : changes) {
    const std::string backup = path_ + ".backup";
    std::filesystem::copy_file(path_, backup);
    run_sql(path_, sql);
    EXPECT_EQ(damage_found_by_check().rfind("a: its names, labels, captions or tags", 0), 0u)
        << sql << damage_found_by_check();
    const db::Database database(path_, db::OpenMode::read_only);
    for (const std::string& message :
         {error_of([&] { database.clip(id_); }), error_of([&] { database.clips(); })}) {
      EXPECT_NE(message.find("clip 'a'"), std::string::npos) << sql << message;
      EXPECT_NE(message.find("checksum differs"), std::string::npos) << sql;
    }
    std::filesystem::rename(backup, path_);
  }
}

TEST_F(ChecksumTest, TheLowestBitOfAPositionCounts) {
  // The content hash rounds to 0.1 mm and does not see it.
  run_sql(path_,
          "UPDATE motion SET positions = CAST(substr(positions, 1, 4) || CASE substr(positions, 5, "
          "1) WHEN x'00' THEN x'01' ELSE x'00' END || substr(positions, 6) AS BLOB)");
  EXPECT_NE(damage_found_by_check().find("its checksum differs"), std::string::npos)
      << damage_found_by_check();
  const db::Database database(path_, db::OpenMode::read_only);
  const std::string message = error_of([&] { database.motion(id_); });
  EXPECT_NE(message.find("the motion of clip 'a' is damaged"), std::string::npos) << message;
}

TEST_F(ChecksumTest, VectorsOfTheRightLengthAreCompared) {
  run_sql(path_, "UPDATE embedding SET motion = x'cdcc4c3f9a99193f'");  // 0.8, 0.6
  EXPECT_NE(damage_found_by_check().find("checksum differs"), std::string::npos);
  const db::Database database(path_, db::OpenMode::read_only);
  for (const std::string& message : {error_of([&] { database.embeddings("r"); }),
                                     error_of([&] { database.embedding("r", id_); })}) {
    EXPECT_NE(message.find("run: remomask index " + path_), std::string::npos) << message;
  }
}

TEST_F(ChecksumTest, ChangesOfTheProgramKeepThemRight) {
  {
    db::Database database(path_, db::OpenMode::read_write);
    db::ClipChanges changes;
    changes.captions = {"someone runs.", "a run."};
    changes.tags = {"z", "a"};
    changes.split = "val";
    changes.labels = nlohmann::json{{"content", "run"}, {"speed", 1.25}};
    database.update_clip(id_, changes);
  }
  EXPECT_EQ(damage_found_by_check(), "");
}

TEST_F(ChecksumTest, ForeignTriggersViewsAndTablesAreRefusedByName) {
  const std::pair<const char*, const char*> foreign[] = {
      {"CREATE TRIGGER thief AFTER INSERT ON tag BEGIN DELETE FROM clip; END", "trigger 'thief'"},
      {"CREATE VIEW endless AS WITH RECURSIVE n (x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) "
       "SELECT x FROM n",
       "view 'endless'"},
      {"CREATE TABLE mine (x)", "table 'mine'"},
      {"DROP VIEW caption_row; CREATE VIEW caption_row AS WITH RECURSIVE n (id) AS (SELECT 1 UNION "
       "ALL SELECT id + 1 FROM n) SELECT id, 'x' AS text FROM n",
       "view 'caption_row' is not the one"},
      {"DROP TRIGGER caption_updated", "trigger 'caption_updated' is missing"},
  };
  for (const auto& [sql, words] : foreign) {
    const std::string backup = path_ + ".backup";
    std::filesystem::copy_file(path_, backup);
    run_sql(path_, sql);
    for (const std::string& message :
         {error_of([&] { db::check_database(path_); }),
          error_of([&] { db::Database(path_, db::OpenMode::read_only); }),
          error_of([&] { db::Database(path_, db::OpenMode::read_write); })}) {
      EXPECT_NE(message.find(words), std::string::npos) << sql << ": " << message;
    }
    std::filesystem::rename(backup, path_);
  }
}

TEST_F(ChecksumTest, StoringIntoARemovedFileFails) {
  db::Database database(path_, db::OpenMode::read_write);
  db::Transaction transaction(database);
  database.add_clip(named_clip("b"), walking_motion(30, 2));
  std::filesystem::remove(path_);
  EXPECT_NE(error_of([&] { transaction.commit(); }).find("was removed or replaced"),
            std::string::npos);
}

}  // namespace
}  // namespace remomask
