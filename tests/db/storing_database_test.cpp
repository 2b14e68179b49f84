#include "db/storing_database.h"

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
  { StoringDatabase storing(path_); }
  EXPECT_TRUE(files().empty());
  EXPECT_THROW(
      {
        StoringDatabase storing(path_);
        (*storing).begin();
        (*storing).add_clip(named_clip("a"), walking_motion(30, 1));
        throw Error("before the commit");
      },
      Error);
  EXPECT_TRUE(files().empty());
}

TEST_F(StoringDatabaseTest, KeepsWhatWasStored) {
  {
    StoringDatabase storing(path_);
    (*storing).add_clip(named_clip("a"), walking_motion(30, 1));
  }
  EXPECT_EQ(Database(path_, OpenMode::read_only).clip_count(), 1);
  { StoringDatabase storing(path_); }
  EXPECT_EQ(Database(path_, OpenMode::read_only).clip_count(), 1);
}

TEST_F(StoringDatabaseTest, KeepsAnEmptyDatabaseThatWasThere) {
  { Database database(path_, OpenMode::create); }
  { StoringDatabase storing(path_); }
  EXPECT_TRUE(fs::exists(path_));
}

TEST_F(StoringDatabaseTest, KeepsWhatAnotherProgramUses) {
  auto storing = std::make_unique<StoringDatabase>(path_);
  Database other(path_, OpenMode::read_write);
  EXPECT_EQ(other.clip_count(), 0);
  storing.reset();
  ASSERT_TRUE(fs::exists(path_));
  other.add_clip(named_clip("a"), walking_motion(30, 1));
  EXPECT_EQ(Database(path_, OpenMode::read_only).clip_count(), 1);
}

}  // namespace
}  // namespace remomask
