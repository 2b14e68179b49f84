#include "db/snapshot.h"

#include <fstream>

#include "db/check.h"
#include "db/database.h"
#include "db/transaction.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

class SnapshotTest : public testing::Test {
 protected:
  void SetUp() override {
    db::Database database(path_, db::OpenMode::create);
    for (int i = 0; i < 20; ++i) {
      database.add_clip(named_clip("a" + std::to_string(i)), walking_motion(60, i));
    }
    before_ = describe_database(database);
  }
  nlohmann::json content(const std::string& path) {
    return describe_database(db::Database(path, db::OpenMode::read_only));
  }
  int files() {
    return static_cast<int>(std::distance(fs::directory_iterator(folder_.path()), {}));
  }

  TestFolder folder_;
  std::string path_ = folder_ / "d", copy_ = folder_ / "copy";
  nlohmann::json before_;
};

TEST_F(SnapshotTest, IsOneFileOfOneMomentWhileAnotherProgramWrites) {
  db::Database writer(path_, db::OpenMode::read_write);
  db::Transaction transaction(writer);
  writer.add_clip(named_clip("later"), walking_motion(30, 30));
  db::snapshot_database(path_, copy_, false);
  transaction.commit();
  EXPECT_EQ(content(copy_), before_);
  EXPECT_EQ(db::Database(copy_, db::OpenMode::read_only).uuid(), writer.uuid());
  EXPECT_FALSE(fs::exists(copy_ + "-wal"));
  EXPECT_TRUE(db::check_database(copy_).defects.empty());
  EXPECT_NE(error_of([&] { db::snapshot_database(path_, copy_, false); }).find("--force"),
            std::string::npos);
  EXPECT_EQ(content(copy_), before_);
  db::snapshot_database(path_, copy_, true);
  EXPECT_EQ(content(copy_).size(), 21u);
  EXPECT_THROW(db::snapshot_database(path_, path_, true), Error);
  EXPECT_THROW(db::snapshot_database(folder_ / "none", folder_ / "n", false), Error);
  EXPECT_FALSE(fs::exists(folder_ / "n"));
}

TEST_F(SnapshotTest, RestoreBringsTheOldContentUnderANewIdentity) {
  db::snapshot_database(path_, copy_, false);
  db::Database reader(path_, db::OpenMode::read_only);
  const std::string uuid = reader.uuid();
  {
    db::Database database(path_, db::OpenMode::read_write);
    database.remove({1, 2, 3});
  }
  EXPECT_NE(error_of([&] { db::restore_database(copy_, path_, false); }).find("--force"),
            std::string::npos);
  EXPECT_EQ(reader.clip_count(), 17);
  {
    // A program that reads keeps its state until it is done.
    const db::ReadSnapshot snapshot(reader);
    EXPECT_EQ(db::restore_database(copy_, path_, true).set_aside, "");
    EXPECT_EQ(reader.clip_count(), 17);
  }
  EXPECT_EQ(describe_database(reader), before_);
  EXPECT_NE(reader.uuid(), uuid);
  EXPECT_TRUE(db::check_database(path_).defects.empty());
  // It can be written as before.
  db::Database(path_, db::OpenMode::read_write).remove({1});
  EXPECT_EQ(content(copy_), before_);
  // To a place where none was.
  db::restore_database(copy_, folder_ / "new", false);
  EXPECT_EQ(content(folder_ / "new"), before_);
}

TEST_F(SnapshotTest, ARestoreThatFailsLeavesTheOldDatabase) {
  std::ofstream(copy_) << "no database at all";
  EXPECT_THROW(db::restore_database(copy_, path_, true), Error);
  EXPECT_EQ(content(path_), before_);
  fs::remove(copy_);
  db::snapshot_database(path_, copy_, false);
  const auto size = fs::file_size(copy_);
  std::fstream file(copy_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(size / 2));
  file << std::string(20000, '\x5a');
  file.close();
  EXPECT_THROW(db::restore_database(copy_, path_, true), Error);
  EXPECT_EQ(content(path_), before_);
  fs::remove(copy_);
  db::snapshot_database(path_, copy_, false);
  std::stop_source stop;
  stop.request_stop();
  Monitor monitor;
  monitor.stop = stop.get_token();
  // So small a database is copied in one step: it is stopped or it is done.
  const int before = files();
  try {
    db::restore_database(copy_, path_, true, monitor);
  } catch (const Interrupted&) {
  }
  EXPECT_EQ(content(path_), before_);
  EXPECT_EQ(files(), before);
  db::Database writer(path_, db::OpenMode::read_write);
  {
    const db::Transaction undone(writer);
    EXPECT_NE(error_of([&] { db::restore_database(copy_, path_, true); }).find("is writing"),
              std::string::npos);
  }
  EXPECT_EQ(content(path_), before_);
}

TEST_F(SnapshotTest, ADamagedDatabaseIsSetAsideWithItsLog) {
  db::snapshot_database(path_, copy_, false);
  std::ofstream(path_) << std::string(8192, 'x');
  std::ofstream(path_ + "-wal") << "rest of a log";
  EXPECT_THROW(db::restore_database(copy_, path_, false), Error);
  const db::RestoreReport report = db::restore_database(copy_, path_, true);
  EXPECT_EQ(report.set_aside, path_ + ".damaged");
  EXPECT_EQ(fs::file_size(report.set_aside), 8192u);
  EXPECT_EQ(content(path_), before_);
  // A log alone would be taken for that of the restored file.
  fs::remove(path_);
  std::ofstream(path_ + "-wal") << "rest of a log";
  EXPECT_EQ(db::restore_database(copy_, path_, false).set_aside, path_ + ".damaged2");
  EXPECT_EQ(content(path_), before_);
}

TEST_F(SnapshotTest, OtherProgramsFilesAreLeftAlone) {
  db::snapshot_database(path_, copy_, false);
  run_sql(folder_ / "other", "CREATE TABLE t (x)");
  EXPECT_NE(error_of([&] {
              db::restore_database(copy_, folder_ / "other", true);
            }).find("another program"),
            std::string::npos);
  run_sql(folder_ / "other", "SELECT * FROM t");
}

}  // namespace
}  // namespace remomask
