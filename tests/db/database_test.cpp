#include "db/database.h"

#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <limits>
#include <memory>

#include "db/clip_hash.h"
#include "db/page_checksums.h"
#include "db/sqlite.h"
#include "db/transaction.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

Motion small_motion(int frames, float value) {
  Motion motion(frames, 22);
  for (size_t i = 0; i < motion.positions.size(); ++i) {
    motion.positions[i] = value + 0.25f * static_cast<float>(i % 97);
  }
  return motion;
}

TEST(Database, KeepsClipsOverReopening) {
  TestFolder folder;
  const std::string path = folder / "motions.sqlite";
  const Motion motion = small_motion(30, 1.f);
  db::Clip clip = named_clip("01_01#2");
  clip.start_frame = 312;
  clip.split = "val";
  clip.mirrored = true;
  clip.labels["nested"] = {{"a", 1.5}};
  clip.captions.push_back("Ünïcode \"quoted\" 'caption'; DROP TABLE clip");
  std::string uuid;
  int64_t id = 0;
  {
    db::Database database(path, db::OpenMode::create);
    uuid = database.uuid();
    id = database.add_clip(clip, motion);
  }
  const db::Database database(path, db::OpenMode::read_only);
  EXPECT_EQ(database.uuid(), uuid);
  EXPECT_EQ(uuid.size(), 36u);
  EXPECT_EQ(database.clip_count(), 1);
  const db::Clip stored = database.clip(id);
  EXPECT_EQ(stored.name, clip.name);
  EXPECT_EQ(stored.source, clip.source);
  EXPECT_EQ(stored.source_file, clip.source_file);
  EXPECT_EQ(stored.start_frame, 312);
  EXPECT_EQ(stored.split, "val");
  EXPECT_EQ(stored.licence, "CC0");
  EXPECT_EQ(stored.group, clip.group);
  EXPECT_TRUE(stored.mirrored);
  EXPECT_EQ(stored.frames, 30);
  EXPECT_EQ(stored.captions, clip.captions);
  EXPECT_EQ(stored.labels, clip.labels);
  EXPECT_EQ(stored.content_hash, db::clip_content_hash(motion));
  EXPECT_EQ(database.motion(id).positions, motion.positions);
  EXPECT_EQ(database.clips().at(0).captions, clip.captions);
}

TEST(Database, TwoDatabasesHaveTwoIdentities) {
  TestFolder folder;
  EXPECT_NE(db::Database(folder / "a", db::OpenMode::create).uuid(),
            db::Database(folder / "b", db::OpenMode::create).uuid());
}

TEST(Database, FindsByNameAndContent) {
  TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  const int64_t first = database.add_clip(named_clip("a"), small_motion(20, 0.f));
  const int64_t second = database.add_clip(named_clip("b"), small_motion(20, 1.f));
  EXPECT_EQ(database.find_name("b"), second);
  EXPECT_EQ(database.find_name("c"), std::nullopt);
  EXPECT_EQ(database.find_content(db::clip_content_hash(small_motion(20, 0.f))), first);
  EXPECT_EQ(database.find_content("00"), std::nullopt);
}

TEST(Database, RefusesTheSameNameOrMotion) {
  TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  database.add_clip(named_clip("a"), small_motion(20, 0.f));
  const int64_t generation = database.generation();
  EXPECT_NE(error_of([&] {
              database.add_clip(named_clip("a"), small_motion(20, 1.f));
            }).find("a clip 'a' already"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              database.add_clip(named_clip("b"), small_motion(20, 0.f));
            }).find("same motion as the stored clip 'a'"),
            std::string::npos);
  EXPECT_EQ(database.clip_count(), 1);
  EXPECT_EQ(database.generation(), generation);
}

TEST(Database, RefusesClipsThatMakeNoSense) {
  TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  db::Clip clip = named_clip("a");
  clip.split = "training";
  EXPECT_THROW(database.add_clip(clip, small_motion(20, 0.f)), Error);
  Motion cut = small_motion(20, 0.f);
  cut.positions.pop_back();
  EXPECT_THROW(database.add_clip(named_clip("a"), cut), Error);
  EXPECT_THROW(database.add_clip(named_clip("a"), Motion(0, 22)), Error);
  Motion broken = small_motion(20, 0.f);
  broken.positions[5] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(database.add_clip(named_clip("a"), broken), Error);
  EXPECT_EQ(database.clip_count(), 0);
}

TEST(Database, HashSeesATenthOfAMillimetreAndNoLess) {
  Motion motion = small_motion(20, 0.f);
  const std::string hash = db::clip_content_hash(motion);
  motion.positions[7] += 0.00002f;
  EXPECT_EQ(db::clip_content_hash(motion), hash);
  motion.positions[7] += 0.0002f;
  EXPECT_NE(db::clip_content_hash(motion), hash);
}

TEST(Database, RolledBackTransactionLeavesNothing) {
  TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  const int64_t kept = database.add_clip(named_clip("a"), small_motion(20, 0.f));
  const int64_t generation = database.generation();
  auto transaction = std::make_unique<db::Transaction>(database);
  database.add_clip(named_clip("b"), small_motion(20, 1.f));
  database.remove_clips("test", "a");
  database.note_imported_file("test", "b", "f", "stored");
  // A failing statement inside does not end the transaction.
  EXPECT_THROW(database.add_clip(named_clip("b"), small_motion(20, 2.f)), Error);
  EXPECT_EQ(database.clip_count(), 1);
  EXPECT_GT(database.generation(), generation);
  transaction.reset();
  EXPECT_EQ(database.find_name("a"), kept);
  EXPECT_EQ(database.clip_count(), 1);
  EXPECT_EQ(database.generation(), generation);
  EXPECT_FALSE(database.file_is_imported("test", "b", "f"));
}

TEST(Database, UncommittedWorkIsLostWithTheProgram) {
  TestFolder folder;
  const std::string path = folder / "d";
  {
    db::Database database(path, db::OpenMode::create);
    db::Transaction kept(database);
    database.add_clip(named_clip("a"), small_motion(20, 0.f));
    kept.commit();
    const db::Transaction lost(database);
    database.add_clip(named_clip("b"), small_motion(20, 1.f));
  }
  const db::Database database(path, db::OpenMode::read_only);
  EXPECT_TRUE(database.find_name("a"));
  EXPECT_FALSE(database.find_name("b"));
}

TEST(Database, RemovedClipsTakeEverythingWithThemAndTheirIdsNeverReturn) {
  TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  const int64_t id = database.add_clip(named_clip("a"), small_motion(20, 0.f));
  database.store_embeddings("r", {{id, {1.f}, {1.f}, {1.f}}});
  EXPECT_EQ(database.remove_clips("test", "other"), 0);
  EXPECT_EQ(database.remove_clips("test", "a"), 1);
  EXPECT_TRUE(database.embeddings("r").empty());
  EXPECT_THROW(database.motion(id), Error);
  EXPECT_THROW(database.clip(id), Error);
  EXPECT_GT(database.add_clip(named_clip("a"), small_motion(20, 0.f)), id);
}

TEST(Database, EmbeddingsRoundTripAndAreReplaced) {
  TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  const int64_t a = database.add_clip(named_clip("a"), small_motion(20, 0.f));
  const int64_t b = database.add_clip(named_clip("b"), small_motion(20, 1.f));
  const int64_t before = database.generation();
  database.store_embeddings("r1", {{b, {3.f, 4.f}, {5.f}, {}}, {a, {1.f, 2.f}, {}, {6.f}}});
  database.store_embeddings("r2", {{a, {9.f}, {9.f}, {9.f}}});
  EXPECT_EQ(database.generation(), before + 2);
  const auto stored = database.embeddings("r1");
  ASSERT_EQ(stored.size(), 2u);
  EXPECT_EQ(stored[0].clip_id, a);
  EXPECT_EQ(stored[0].motion, (std::vector<float>{1.f, 2.f}));
  EXPECT_TRUE(stored[0].parts.empty());
  EXPECT_EQ(stored[1].parts, (std::vector<float>{5.f}));
  EXPECT_TRUE(stored[1].text.empty());
  database.store_embeddings("r1", {{b, {7.f}, {}, {}}});
  EXPECT_EQ(database.embeddings("r1").size(), 1u);
  EXPECT_EQ(database.embeddings("r2").size(), 1u);
  // Of a clip that is not there: nothing changes.
  EXPECT_THROW(database.store_embeddings("r1", {{b + 1, {7.f}, {}, {}}}), Error);
  EXPECT_EQ(database.embeddings("r1").size(), 1u);
}

TEST(Database, NotesOfImportsAndFacts) {
  TestFolder folder;
  db::Database database(folder / "d", db::OpenMode::create);
  const int64_t generation = database.generation();
  database.note_imported_file("s", "a.bvh", "1", "stored");
  EXPECT_TRUE(database.file_is_imported("s", "a.bvh", "1"));
  EXPECT_FALSE(database.file_is_imported("s", "a.bvh", "2"));
  EXPECT_FALSE(database.file_is_imported("t", "a.bvh", "1"));
  database.note_imported_file("s", "a.bvh", "2", "stored");
  EXPECT_TRUE(database.file_is_imported("s", "a.bvh", "2"));
  EXPECT_EQ(database.imported_files("s"), (std::map<std::string, std::string>{{"a.bvh", "2"}}));
  database.set_fact("title", "mine");
  EXPECT_EQ(database.fact("title"), "mine");
  EXPECT_EQ(database.fact("nothing"), std::nullopt);
  EXPECT_THROW(database.set_fact("uuid", "x"), Error);
  EXPECT_EQ(database.generation(), generation);
}

TEST(Database, MissingFileFolderAndGarbageAreNamed) {
  TestFolder folder;
  EXPECT_NE(error_of([&] {
              db::Database(folder / "none", db::OpenMode::read_write);
            }).find("there is no such database"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "none"));
  EXPECT_NE(
      error_of([&] { db::Database(folder.path(), db::OpenMode::create); }).find("is a folder"),
      std::string::npos);
  EXPECT_NE(error_of([&] {
              db::Database(folder / "no/such/d", db::OpenMode::create);
            }).find("check that the path exists"),
            std::string::npos);
  const std::string garbage = folder / "garbage";
  std::ofstream(garbage) << std::string(4096, 'x');
  for (const db::OpenMode mode :
       {db::OpenMode::read_only, db::OpenMode::read_write, db::OpenMode::create}) {
    EXPECT_NE(error_of([&] { db::Database(garbage, mode); }).find("not a motion database"),
              std::string::npos);
  }
  std::ofstream(folder / "empty");
  EXPECT_NE(error_of([&] {
              db::Database(folder / "empty", db::OpenMode::read_write);
            }).find("is not a motion database"),
            std::string::npos);
}

TEST(Database, OtherProgramsAndNewerVersionsAreRefused) {
  TestFolder folder;
  run_sql(folder / "other", "CREATE TABLE t (x); INSERT INTO t VALUES (1)");
  EXPECT_NE(error_of([&] {
              db::Database(folder / "other", db::OpenMode::create);
            }).find("is not a motion database"),
            std::string::npos);
  { db::Database database(folder / "new", db::OpenMode::create); }
  run_sql(folder / "new", "PRAGMA user_version = 8");
  EXPECT_NE(error_of([&] {
              db::Database(folder / "new", db::OpenMode::read_only);
            }).find("newer version"),
            std::string::npos);
}

TEST(Database, DamageIsReported) {
  TestFolder folder;
  const std::string path = folder / "d";
  int64_t id = 0;
  {
    db::Database database(path, db::OpenMode::create);
    id = database.add_clip(named_clip("a"), small_motion(20, 0.f));
  }
  run_sql(path, "UPDATE motion SET positions = x'0102030405'");
  EXPECT_NE(
      error_of([&] { db::Database(path, db::OpenMode::read_only).motion(id); }).find("damaged"),
      std::string::npos);
  const auto size = std::filesystem::file_size(path);
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(4096);
  file << std::string(size - 4096, '\x5a');
  file.close();
  const std::string message =
      error_of([&] { db::Database(path, db::OpenMode::read_only).clips(); });
  EXPECT_NE(message.find("damaged"), std::string::npos) << message;
}

TEST(Database, ReadOnlyFilesCanBeReadAndNotWritten) {
  TestFolder folder;
  std::filesystem::create_directory(folder / "shelf");
  const std::string path = folder / "shelf/d";
  { db::Database(path, db::OpenMode::create).add_clip(named_clip("a"), small_motion(20, 0.f)); }
  db::Database database(path, db::OpenMode::read_only);
  EXPECT_NE(error_of([&] {
              database.add_clip(named_clip("b"), small_motion(20, 1.f));
            }).find("cannot be written"),
            std::string::npos);
  if (::geteuid() == 0) return;  // permissions do not bind the superuser
  ::chmod(path.c_str(), 0444);
  ::chmod((folder / "shelf").c_str(), 0555);
  EXPECT_EQ(db::Database(path, db::OpenMode::read_only).clip_count(), 1);
  EXPECT_NE(
      error_of([&] { db::Database(path, db::OpenMode::read_write); }).find("cannot be written"),
      std::string::npos);
  ::chmod((folder / "shelf").c_str(), 0755);
}

TEST(Database, JournalOfAKilledWriterIsPlayedBackByReaders) {
  TestFolder folder;
  {
    db::Database database(folder / "d", db::OpenMode::create);
    for (int i = 0; i < 8; ++i) {
      database.add_clip(named_clip("clip" + std::to_string(i)), walking_motion(60, i));
    }
  }
  // A writer without WAL that is killed after half of its pages went to the file:
  // file and journal as they lie on the disk in the middle of its transaction.
  sqlite3* writer = nullptr;
  ASSERT_EQ(sqlite3_open_v2((folder / "d").c_str(), &writer, SQLITE_OPEN_READWRITE,
                            db::page_checksum_vfs()),
            SQLITE_OK);
  const auto run = [&](const char* sql) {
    ASSERT_EQ(sqlite3_exec(writer, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sql;
  };
  run("PRAGMA journal_mode = DELETE");
  run("PRAGMA cache_size = 1");
  run("BEGIN");
  run("UPDATE motion SET positions = zeroblob(length(positions))");
  run("UPDATE clip SET name = 'lost' || id");
  std::filesystem::copy_file(folder / "d", folder / "killed");
  std::filesystem::copy_file(folder / "d-journal", folder / "killed-journal");
  run("ROLLBACK");
  sqlite3_close(writer);

  const db::Database killed(folder / "killed", db::OpenMode::read_only);
  EXPECT_EQ(killed.clip_count(), 8);
  EXPECT_TRUE(killed.find_name("clip0").has_value());
  const auto id = killed.find_name("clip7");
  ASSERT_TRUE(id.has_value());
  EXPECT_EQ(killed.motion(*id).positions, walking_motion(60, 7).positions);
  EXPECT_FALSE(std::filesystem::exists(folder / "killed-journal"));
}

TEST(Database, ReadersSeeTheLastCommitAndASecondWriterIsTold) {
  TestFolder folder;
  const std::string path = folder / "d";
  db::Database writer(path, db::OpenMode::create);
  db::Transaction transaction(writer);
  writer.add_clip(named_clip("a"), small_motion(20, 0.f));
  EXPECT_EQ(db::Database(path, db::OpenMode::read_only).clip_count(), 0);
  db::Database second(path, db::OpenMode::read_write);
  EXPECT_NE(error_of([&] { db::Transaction refused(second); }).find("another program is writing"),
            std::string::npos);
  transaction.commit();
  EXPECT_EQ(second.clip_count(), 1);
}

TEST(Database, ReadersLeaveNoFilesBeside) {
  TestFolder folder;
  const std::string path = folder / "d";
  { db::Database(path, db::OpenMode::create).add_clip(named_clip("a"), small_motion(20, 0.f)); }
  const auto files = [&] {
    return std::distance(std::filesystem::directory_iterator(folder.path()), {});
  };
  {
    db::Database reader(path, db::OpenMode::read_only);
    EXPECT_EQ(reader.clip_count(), 1);
    // Other connections come, write and go meanwhile.
    db::Database(path, db::OpenMode::read_write).set_fact("key", "value");
    EXPECT_EQ(reader.fact("key"), "value");
    { const db::ReadSnapshot snapshot(reader); }
    EXPECT_NE(error_of([&] { reader.set_fact("key", "other"); }).find("readonly"),
              std::string::npos);
  }
  EXPECT_EQ(files(), 1);
  EXPECT_EQ(db::Database(path, db::OpenMode::read_only).fact("key"), "value");
  EXPECT_EQ(files(), 1);
}

TEST(Database, FullDiskIsNamed) {
  TestFolder folder;
  const db::SqliteConnection connection(folder / "d", db::SqliteMode::create);
  connection.execute("CREATE TABLE t (x)");
  // SQLite's own limit of pages raises the same error as a full disk.
  connection.execute("PRAGMA max_page_count = 10");
  const std::string message =
      error_of([&] { connection.execute("INSERT INTO t VALUES (zeroblob(1000000))"); });
  EXPECT_NE(message.find("disk is full; free some space"), std::string::npos) << message;
}

TEST(Transaction, KeepsNothingOfWhatAnExceptionCut) {
  const TestFolder folder;
  db::Database database(folder / "t.sqlite", db::OpenMode::create);
  const auto store = [&](const std::string& value, bool fail) {
    db::Transaction transaction(database);
    database.set_fact("key", value);
    if (fail) throw Error("in the middle");
    transaction.commit();
  };
  store("first", false);
  EXPECT_THROW(store("second", true), Error);
  EXPECT_EQ(database.fact("key"), "first");
  store("third", false);
  EXPECT_EQ(database.fact("key"), "third");
}

}  // namespace
}  // namespace remomask
