#include <gtest/gtest.h>

#include <filesystem>

#include "db/check.h"
#include "db/database.h"
#include "db/upgrade.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

/// A copy of the file that the program of this version wrote: clips "walk" and "jump", vectors of
/// "walk".
std::string old_database(const TestFolder& folder, int version) {
  const std::string name = "database_" + std::to_string(version) + ".sqlite";
  const std::string copy = folder / name;
  fs::copy_file(std::string(REMOMASK_SOURCE_DIR "/tests/data/formats/") + name, copy);
  // The checkout may be read-only, and a copy keeps the permissions.
  fs::permissions(copy, fs::perms::owner_write, fs::perm_options::add);
  return copy;
}

void expect_content(const db::Database& database) {
  EXPECT_EQ(database.clip_count(), 2);
  const int64_t walk = *database.find_name("walk");
  EXPECT_EQ(database.clip(walk).captions, (std::vector<std::string>{"a person walks."}));
  EXPECT_EQ(database.match_captions("jump").at(0).clip_id, *database.find_name("jump"));
  EXPECT_EQ(database.motion(walk).frames, 20);
  // 0.05 m a frame.
  EXPECT_NEAR(database.clip(walk).speed, 1, 0.01);
  EXPECT_EQ(database.embeddings("r").at(0).parts, (std::vector<float>{0.5f}));
}

TEST(OldFormats, Version1IsRefusedForReading) {
  const TestFolder folder;
  const std::string path = old_database(folder, 1);
  const std::string message = error_of([&] { db::Database(path, db::OpenMode::read_only); });
  EXPECT_NE(message.find("remomask db upgrade " + path), std::string::npos) << message;
}

TEST(OldFormats, Version2IsReadAsItIs) {
  const TestFolder folder;
  const std::string path = old_database(folder, 2);
  const db::Database database(path, db::OpenMode::read_only);
  expect_content(database);
  EXPECT_FALSE(database.embedding_changes("r", 0));
}

TEST(OldFormats, AllAreUpgradedWhenTheyAreWritten) {
  for (const int version : {1, 2, 3, 4, 5}) {
    const TestFolder folder;
    const std::string path = old_database(folder, version);
    expect_content(db::Database(path, db::OpenMode::read_write));
    EXPECT_TRUE(db::check_database(path).defects.empty());
    EXPECT_EQ(db::upgrade_database(path).version_before, 6);
  }
}

TEST(OldFormats, ANewerVersionIsRefused) {
  const TestFolder folder;
  const std::string path = old_database(folder, 2);
  run_sql(path, "PRAGMA user_version = 8");
  for (const auto mode : {db::OpenMode::read_only, db::OpenMode::read_write}) {
    EXPECT_NE(error_of([&] { db::Database(path, mode); }).find("newer version of remomask"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace remomask
