#include "db/check.h"

#include <fstream>

#include "db/database.h"
#include "db/upgrade.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

class CheckTest : public testing::Test {
 protected:
  void SetUp() override {
    db::Database database(path_, db::OpenMode::create);
    for (const char* name : {"a", "b", "c"}) {
      const int64_t id =
          database.add_clip(named_clip(name), walking_motion(24, static_cast<int>(*name)));
      database.add_embeddings("r", {{id, {0.6f, 0.8f}, {1.f, 0.f}, {1.f, 0.f}}});
    }
  }
  /// Of clip b alone; "" when it has none.
  std::string defect() {
    const db::CheckReport report = db::check_database(path_);
    if (report.defects.empty()) return "";
    EXPECT_EQ(report.defects.size(), 1u);
    EXPECT_EQ(report.defects[0].clip_id, 2) << report.defects[0].what;
    EXPECT_EQ(report.defects[0].clip, "b");
    return report.defects[0].what;
  }
  void expect_defect(const char* sql, const std::string& words) {
    ASSERT_EQ(defect(), "");
    const std::string backup = path_ + ".backup";
    std::filesystem::copy_file(path_, backup);
    run_sql(path_, sql);
    const std::string found = defect();
    EXPECT_NE(found.find(words), std::string::npos) << sql << ": " << found;
    std::filesystem::remove(path_);
    std::filesystem::rename(backup, path_);
  }

  TestFolder folder_;
  std::string path_ = folder_ / "d";
};

TEST_F(CheckTest, CountsWhatIsInOrder) {
  const db::CheckReport report = db::check_database(path_);
  EXPECT_EQ(report.clips, 3);
  EXPECT_EQ(report.captions, 6);
  EXPECT_EQ(report.embeddings, 3);
  EXPECT_TRUE(report.defects.empty());
}

TEST_F(CheckTest, FindsEveryKindOfDefectOfAClip) {
  expect_defect("UPDATE motion SET positions = x'00000000' WHERE clip_id = 2", "4 bytes");
  expect_defect("UPDATE motion SET frames = 12 WHERE clip_id = 2", "its motion 12");
  expect_defect("UPDATE clip SET frames = 12 WHERE id = 2", "has 12 frames, its motion 24");
  expect_defect("DELETE FROM motion WHERE clip_id = 2", "has no motion");
  // 00 00 c0 7f is a NaN.
  expect_defect(
      "UPDATE motion SET positions = CAST(x'0000c07f' || substr(positions, 5) AS BLOB) "
      "WHERE clip_id = 2",
      "no number of metres");
  expect_defect(
      "UPDATE motion SET positions = CAST(x'0000803f' || substr(positions, 5) AS BLOB) "
      "WHERE clip_id = 2",
      "content hash differs");
  expect_defect("UPDATE clip SET speed = 9 WHERE id = 2", "speed");
  expect_defect("UPDATE clip SET labels = '{' WHERE id = 2", "labels");
  expect_defect("UPDATE clip SET labels = '[]' WHERE id = 2", "labels");
  expect_defect("UPDATE caption SET position = 5 WHERE clip_id = 2 AND position = 1",
                "not numbered");
  expect_defect("UPDATE embedding SET motion = x'0000803f' WHERE clip_id = 2", "vectors");
  expect_defect("UPDATE embedding SET parts = x'0000803f' WHERE clip_id = 2", "vectors");
  expect_defect("UPDATE embedding SET motion = zeroblob(8) WHERE clip_id = 2", "length 1");
  expect_defect("UPDATE embedding SET text = x'0000c07f00000000' WHERE clip_id = 2", "length 1");
}

TEST_F(CheckTest, FindsAFullTextIndexOutOfStepAndUpgradeMendsIt) {
  const char* break_it[] = {
      "INSERT INTO caption_words (caption_words, rowid, text) "
      "VALUES ('delete', 2048, 'a person walks.')",
      "INSERT INTO caption_words (rowid, text) VALUES (2055, 'more')",
  };
  for (const char* sql : break_it) {
    run_sql(path_, sql);
    EXPECT_NE(defect().find("full-text index"), std::string::npos) << sql;
    db::upgrade_database(path_);
    EXPECT_EQ(defect(), "");
  }
}

TEST_F(CheckTest, FindsDamageOfTheWhole) {
  run_sql(path_, "PRAGMA foreign_keys = OFF; DELETE FROM clip WHERE id = 3");
  db::CheckReport report = db::check_database(path_);
  EXPECT_FALSE(report.defects.empty());
  EXPECT_NE(report.defects[0].what.find("a clip that is not there"), std::string::npos);
  run_sql(path_, "DELETE FROM fact WHERE key = 'uuid'");
  report = db::check_database(path_);
  bool found = false;
  for (const db::Defect& defect : report.defects) {
    found |= defect.what.find("uuid") != std::string::npos;
  }
  EXPECT_TRUE(found);
}

TEST_F(CheckTest, DamagedPagesAreReportedAndDoNotEndTheCheck) {
  const auto size = std::filesystem::file_size(path_);
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(size / 2 / 4096 * 4096));
  file << std::string(8192, '\x5a');
  file.close();
  EXPECT_FALSE(db::check_database(path_).defects.empty());
  std::ofstream(folder_ / "garbage") << std::string(5000, 'x');
  EXPECT_THROW(db::check_database(folder_ / "garbage"), Error);
}

}  // namespace
}  // namespace remomask
