#include "exchange/archive.h"

#include <archive.h>
#include <archive_entry.h>

#include <fstream>

#include "base/file.h"
#include "exchange/import.h"
#include "remomask/motion_file.h"
#include "tests/db/db_test_tools.h"

namespace remomask {
namespace {

struct TarEntry {
  std::string name, content;
  unsigned type = AE_IFREG;
  std::string link;
};

void write_tar(const std::string& path, const std::vector<TarEntry>& entries) {
  struct archive* writer = archive_write_new();
  archive_write_set_format_pax_restricted(writer);
  if (path.ends_with(".xz")) archive_write_add_filter_xz(writer);
  ASSERT_EQ(archive_write_open_filename(writer, path.c_str()), ARCHIVE_OK);
  for (const TarEntry& item : entries) {
    struct archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, item.name.c_str());
    archive_entry_set_perm(entry, 0644);
    archive_entry_set_filetype(entry, item.type);
    archive_entry_set_size(entry, static_cast<la_int64_t>(item.content.size()));
    if (item.type == AE_IFLNK) archive_entry_set_symlink(entry, item.link.c_str());
    if (item.type == AE_IFREG && !item.link.empty()) {
      archive_entry_set_hardlink(entry, item.link.c_str());
    }
    ASSERT_EQ(archive_write_header(writer, entry), ARCHIVE_OK) << archive_error_string(writer);
    archive_write_data(writer, item.content.data(), item.content.size());
    archive_entry_free(entry);
  }
  ASSERT_EQ(archive_write_close(writer), ARCHIVE_OK);
  archive_write_free(writer);
}

TEST(Archive, UnpacksIntoAFolderThatGoesAway) {
  TestFolder folder;
  const std::string path = folder / "set.tar.xz";
  write_tar(path, {{"set/", "", AE_IFDIR, ""},
                   {"./set/a.txt", "one", AE_IFREG, ""},
                   {"set/b/c.txt", "two", AE_IFREG, ""}});
  std::string place;
  {
    const exchange::UnpackedArchive archive(path, {});
    place = archive.folder();
    EXPECT_TRUE(place.ends_with("/set")) << place;
    EXPECT_EQ(read_file(place + "/a.txt"), "one");
    EXPECT_EQ(read_file(place + "/b/c.txt"), "two");
  }
  EXPECT_FALSE(std::filesystem::exists(place));
  EXPECT_EQ(exchange::archive_stem(path), "set");
}

TEST(Archive, RefusesEntriesThatLeaveTheFolder) {
  TestFolder folder;
  const std::string path = folder / "bad.tar";
  const std::string outside = folder / "outside.txt";
  const std::pair<TarEntry, const char*> cases[] = {
      {{"../outside.txt", "x", AE_IFREG, ""}, "leads out"},
      {{"a/../../outside.txt", "x", AE_IFREG, ""}, "leads out"},
      {{outside, "x", AE_IFREG, ""}, "absolute path"},
      {{"link", "", AE_IFLNK, "/etc"}, "is a link"},
      {{"hard", "", AE_IFREG, "good.txt"}, "is a link"},
      {{"pipe", "", AE_IFIFO, ""}, "neither a file nor a folder"},
      {{"device", "", AE_IFCHR, ""}, "neither a file nor a folder"}};
  for (const auto& [entry, message] : cases) {
    write_tar(path, {{"good.txt", "good", AE_IFREG, ""}, entry});
    const std::string error = error_of([&] { exchange::UnpackedArchive(path, {}); });
    EXPECT_NE(error.find(message), std::string::npos) << entry.name << ": " << error;
    EXPECT_FALSE(std::filesystem::exists(outside));
  }
}

TEST(Archive, RefusesDamageAndDoubledNames) {
  TestFolder folder;
  const std::string path = folder / "set.tar.xz";
  std::string noise(200000, '\0');
  for (size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<char>(i * i % 251);
  write_tar(path, {{"a.txt", noise, AE_IFREG, ""}});
  const std::string content = read_file(path);
  std::ofstream(path, std::ios::binary) << content.substr(0, content.size() / 2);
  EXPECT_NE(error_of([&] { exchange::UnpackedArchive(path, {}); }).find("cannot be unpacked"),
            std::string::npos);
  std::ofstream(path, std::ios::binary) << std::string(5000, 'x');
  EXPECT_NE(error_of([&] { exchange::UnpackedArchive(path, {}); }).find("cannot be unpacked"),
            std::string::npos);
  EXPECT_NE(
      error_of([&] { exchange::UnpackedArchive(folder / "none.tar", {}); }).find("no such archive"),
      std::string::npos);
  write_tar(path, {{"a.txt", "1", AE_IFREG, ""}, {"a.txt", "2", AE_IFREG, ""}});
  EXPECT_NE(error_of([&] { exchange::UnpackedArchive(path, {}); }).find("twice"),
            std::string::npos);
}

TEST(Archive, ImportsLikeTheFolderInIt) {
  TestFolder folder;
  std::filesystem::create_directory(folder / "walks");
  save_motion(folder / "walks/a.npy", walking_motion(30, 1));
  save_motion(folder / "walks/b.npy", walking_motion(30, 2));
  write_file_atomically(folder / "walks.jsonl",
                        R"({"clip": "a", "captions": ["one"], "split": "train"})"
                        "\n"
                        R"({"clip": "b", "captions": ["two"], "split": "val"})");
  write_tar(folder / "walks.tar.xz",
            {{"walks/a.npy", read_file(folder / "walks/a.npy"), AE_IFREG, ""},
             {"walks/b.npy", read_file(folder / "walks/b.npy"), AE_IFREG, ""}});
  exchange::ImportOptions options;
  options.folder = folder / "walks.tar.xz";
  db::Database database(folder / "d", db::OpenMode::create),
      other(folder / "e", db::OpenMode::create);
  EXPECT_EQ(exchange::import_folder(database, options).files_stored, 2);
  const int64_t generation = database.generation();
  options.folder = folder / "walks";
  EXPECT_EQ(exchange::import_folder(database, options).files_known, 2);
  EXPECT_EQ(database.generation(), generation);
  exchange::import_folder(other, options);
  EXPECT_EQ(describe_database(database), describe_database(other));
  EXPECT_EQ(database.clips()[0].source, "walks");
  EXPECT_EQ(database.clips()[0].captions, (std::vector<std::string>{"one"}));
}

TEST(Archive, StopsWhenAsked) {
  TestFolder folder;
  write_tar(folder / "set.tar", {{"a.txt", "one", AE_IFREG, ""}});
  std::stop_source stop;
  stop.request_stop();
  Monitor monitor;
  monitor.stop = stop.get_token();
  EXPECT_THROW(exchange::UnpackedArchive(folder / "set.tar", monitor), Interrupted);
}

}  // namespace
}  // namespace remomask
