#include "db/storing_database.h"
#include "db/transaction.h"

#include <filesystem>
#include <memory>
#include <vector>

#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

class StoringDatabaseTest : public testing::Test {
 protected:
  /// Names of all files in the folder.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      names.push_back(entry.path().filename());
    }
    return names;
  }

  TestFolder folder_;
  std::string path_ = folder_ / "d";
};

TEST_F(StoringDatabaseTest, LeavesNothingWhenNothingWasStored) {
  { db::StoringDatabase storing(path_); }
  EXPECT_TRUE(files().empty());
  EXPECT_THROW(
      {
        db::StoringDatabase storing(path_);
        const db::Transaction transaction(*storing);
        (*storing).add_clip(named_clip("a"), walking_motion(30, 1));
        throw Error("before the commit");
      },
      Error);
  EXPECT_TRUE(files().empty());
}

TEST_F(StoringDatabaseTest, KeepsWhatWasStored) {
  {
    db::StoringDatabase storing(path_);
    (*storing).add_clip(named_clip("a"), walking_motion(30, 1));
  }
  EXPECT_EQ(db::Database(path_, db::OpenMode::read_only).clip_count(), 1);
  { db::StoringDatabase storing(path_); }
  EXPECT_EQ(db::Database(path_, db::OpenMode::read_only).clip_count(), 1);
}

TEST_F(StoringDatabaseTest, KeepsAnEmptyDatabaseThatWasThere) {
  { db::Database database(path_, db::OpenMode::create); }
  { db::StoringDatabase storing(path_); }
  EXPECT_TRUE(fs::exists(path_));
}

TEST_F(StoringDatabaseTest, KeepsWhatAnotherProgramUses) {
  auto storing = std::make_unique<db::StoringDatabase>(path_);
  db::Database other(path_, db::OpenMode::read_write);
  EXPECT_EQ(other.clip_count(), 0);
  storing.reset();
  ASSERT_TRUE(fs::exists(path_));
  other.add_clip(named_clip("a"), walking_motion(30, 1));
  EXPECT_EQ(db::Database(path_, db::OpenMode::read_only).clip_count(), 1);
}

}  // namespace
}  // namespace remomask
