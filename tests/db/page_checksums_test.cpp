#include "db/page_checksums.h"

#include <filesystem>

#include "base/file.h"
#include "db/check.h"
#include "db/database.h"
#include "db/snapshot.h"
#include "db/sqlite.h"
#include "db/upgrade.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

constexpr size_t kPage = 4096;

class PageChecksumsTest : public testing::Test {
 protected:
  void SetUp() override {
    db::Database database(path_, db::OpenMode::create);
    for (int i = 0; i < 4; ++i) add(database, i);
    // Its pages are free now: no table uses them.
    database.remove({2});
  }

  static void add(db::Database& database, int number) {
    db::Clip clip = named_clip("clip " + std::to_string(number));
    clip.tags = {"best"};
    const int64_t id = database.add_clip(clip, walking_motion(40, number));
    database.add_embeddings("n", {{id, {0.6f, 0.8f}, {0.5f}, {1.f, 0.f}}});
  }

  /// What a program without the layer does to the file.
  void run_elsewhere(const char* sql) {
    sqlite3* handle = nullptr;
    ASSERT_EQ(sqlite3_open(path_.c_str(), &handle), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(handle, sql, nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(handle);
  }

  /// Also why it cannot be checked at all.
  static std::vector<std::string> defects_of(const std::string& path) {
    std::vector<std::string> defects;
    const std::string refusal = error_of([&] {
      for (const db::Defect& defect : db::check_database(path).defects) {
        defects.push_back(defect.what);
      }
    });
    if (!refusal.empty()) defects.push_back(refusal);
    return defects;
  }

  std::string old_file(int version) {
    const std::string name = "database_" + std::to_string(version) + ".sqlite";
    fs::copy_file(std::string(REMOMASK_SOURCE_DIR "/tests/data/formats/") + name, folder_ / name);
    fs::permissions(folder_ / name, fs::perms::owner_write, fs::perm_options::add);
    return folder_ / name;
  }

  TestFolder folder_;
  std::string path_ = folder_ / "d";
};

TEST_F(PageChecksumsTest, EveryFlippedBitIsNoticedWhateverItsPageIsFor) {
  ASSERT_EQ(defects_of(path_), std::vector<std::string>());
  const std::string sound = read_file(path_);
  const nlohmann::json content = describe_database(db::Database(path_, db::OpenMode::read_only));
  ASSERT_GT(sound.size(), 10 * kPage);
  int refused = 0;
  // A stride that meets every page, and other places in each.
  for (size_t at = 0; at < sound.size(); at += 509) {
    std::string damaged = sound;
    damaged[at] = static_cast<char>(damaged[at] ^ 1 << at % 8);
    write_file_atomically(path_, damaged, Durability::kills);
    EXPECT_FALSE(defects_of(path_).empty()) << "byte " << at;
    const std::string reading = error_of([&] {
      const db::Database database(path_, db::OpenMode::read_only);
      EXPECT_EQ(describe_database(database), content) << "byte " << at;
    });
    refused += reading.empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 100);
}

// SQLite leaves holes in a file for pages that it never used: zeros of those are sound.
TEST_F(PageChecksumsTest, AZeroedPageIsNoticedUnlessItIsFree) {
  const std::string sound = read_file(path_);
  int64_t free = 0, unnoticed = 0;
  {
    const db::SqliteConnection connection(path_, db::SqliteMode::read_only);
    free = connection.integer("PRAGMA freelist_count");
  }
  ASSERT_GT(free, 0);
  for (size_t page = 1; page < sound.size() / kPage; ++page) {
    std::string damaged = sound;
    damaged.replace(page * kPage, kPage, kPage, '\0');
    write_file_atomically(path_, damaged, Durability::kills);
    unnoticed += defects_of(path_).empty() ? 1 : 0;
  }
  EXPECT_LE(unnoticed, free);
}

TEST_F(PageChecksumsTest, AFirstPageThatDeniesThemIsRefused) {
  std::string content = read_file(path_);
  content[20] = 0;
  write_file_atomically(path_, content);
  const std::string message = error_of([&] { db::Database(path_, db::OpenMode::read_only); });
  EXPECT_NE(message.find("its first page is damaged"), std::string::npos) << message;
}

TEST_F(PageChecksumsTest, AMessageSaysWhatIsDamagedAndWhatToDo) {
  std::string content = read_file(path_);
  for (size_t at = kPage + 100; at < content.size(); at += kPage) content[at] ^= 1;
  write_file_atomically(path_, content);
  const std::string message =
      error_of([&] { db::Database(path_, db::OpenMode::read_only).clips(); });
  EXPECT_NE(message.find("a page of the file is damaged"), std::string::npos) << message;
  EXPECT_NE(message.find("restore a snapshot"), std::string::npos) << message;
}

TEST_F(PageChecksumsTest, OldFilesGetThemByAnUpgrade) {
  for (const int version : {1, 2, 3, 4, 5}) {
    const std::string path = old_file(version);
    const auto has_them = [&] {
      const db::SqliteConnection connection(path, db::SqliteMode::read_only);
      connection.integer("PRAGMA user_version");
      return db::has_page_checksums(connection.handle());
    };
    nlohmann::json content;
    {
      // Writing alone does not make the whole file anew.
      db::Database database(path, db::OpenMode::read_write);
      add(database, 7);
      content = describe_database(database);
    }
    EXPECT_FALSE(has_them());
    EXPECT_FALSE(db::check_database(path).has_checksums);
    EXPECT_EQ(db::upgrade_database(path).version, 7);
    EXPECT_TRUE(has_them());
    EXPECT_TRUE(db::check_database(path).has_checksums);
    EXPECT_EQ(defects_of(path), std::vector<std::string>());
    EXPECT_EQ(describe_database(db::Database(path, db::OpenMode::read_only)), content);
  }
}

// Who has the file open while it is upgraded has to write checksums from then on.
TEST_F(PageChecksumsTest, WritersThatWereThereBeforeAnUpgradeFollow) {
  const std::string path = old_file(4);
  {
    db::Database writer(path, db::OpenMode::read_write);
    add(writer, 1);
    db::upgrade_database(path);
    for (int i = 2; i < 12; ++i) add(writer, i);
  }
  EXPECT_EQ(defects_of(path), std::vector<std::string>());
  EXPECT_EQ(db::Database(path, db::OpenMode::read_only).clip_count(), 13);
}

// A log holds pages without checksums, and a copy larger than SQLite's cache is written in any
// order.
TEST_F(PageChecksumsTest, ASnapshotOfALargeLogHasThem) {
  db::Database writer(path_, db::OpenMode::read_write);
  {
    const db::Database reader(path_, db::OpenMode::read_only);
    const db::ReadSnapshot keeps_the_log(reader);
    for (int i = 10; i < 100; ++i) {
      db::Clip clip = named_clip("long " + std::to_string(i));
      writer.add_clip(clip, walking_motion(200, i));
    }
    db::snapshot_database(path_, folder_ / "copy", false);
  }
  EXPECT_GT(fs::file_size(folder_ / "copy"), size_t{4} << 20);
  EXPECT_EQ(defects_of(folder_ / "copy"), std::vector<std::string>());
  EXPECT_EQ(describe_database(db::Database(folder_ / "copy", db::OpenMode::read_only)),
            describe_database(writer));
}

TEST_F(PageChecksumsTest, AnOldSnapshotIsRestoredOntoAFileThatHasThem) {
  const std::string old = old_file(3);
  db::restore_database(old, path_, true);
  EXPECT_EQ(defects_of(path_), std::vector<std::string>());
  EXPECT_TRUE(db::check_database(path_).has_checksums);
  EXPECT_EQ(describe_database(db::Database(path_, db::OpenMode::read_only)),
            describe_database(db::Database(old, db::OpenMode::read_only)));
}

TEST_F(PageChecksumsTest, WhatAnotherProgramWroteCanBeAccepted) {
  run_elsewhere(
      "UPDATE import_log SET outcome = 'x'; UPDATE fact SET value = '77' "
      "WHERE key = 'generation'");
  EXPECT_FALSE(defects_of(path_).empty());
  EXPECT_NE(error_of([&] { db::upgrade_database(path_); }), "");
  db::upgrade_database(path_, /*accept_changes=*/true);
  EXPECT_EQ(defects_of(path_), std::vector<std::string>());
  EXPECT_EQ(db::Database(path_, db::OpenMode::read_only).generation(), 77);
}

}  // namespace
}  // namespace remomask
