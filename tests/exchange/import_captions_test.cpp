#include "base/file.h"
#include "exchange/import.h"
#include "tests/exchange/import_test_tools.h"

namespace remomask {
namespace {

TEST(ImportCaptions, MissingAndExtraCaptionsAreNamed) {
  TestFolder folder;
  const exchange::ImportOptions options = make_walks(folder, 2, ".npy");
  write_file_atomically(folder / "walks.jsonl",
                        "\n" + caption_line("walk_1000") + caption_line("gone"));
  db::Database database(folder / "d", db::OpenMode::create);
  const exchange::ImportReport report = exchange::import_folder(database, options);
  EXPECT_EQ(report.clips_stored, 2);
  ASSERT_EQ(report.warnings.size(), 2u);
  EXPECT_TRUE(any_contains(report.warnings, "walk_1001.npy: "));
  EXPECT_TRUE(any_contains(report.warnings, "walks.jsonl:3: clip 'gone' has no motion file"));
  const db::Clip clip = database.clip(*database.find_name("walk_1001"));
  EXPECT_EQ(clip.split, "none");
  EXPECT_TRUE(clip.captions.empty());
}

TEST(ImportCaptions, AMalformedLineOfCaptionsCostsThatLine) {
  TestFolder folder;
  const exchange::ImportOptions options = make_walks(folder, 1, ".npy");
  db::Database database(folder / "d", db::OpenMode::create);
  const std::string good = caption_line("walk_1000");
  const std::string deep = R"({"clip": "a", "labels": {"x": )" + std::string(100'000, '[') +
                           std::string(100'000, ']') + "}}";
  const std::pair<const char*, const char*> cases[] = {
      {"{\"clip\": \"a\",", "is not JSON"},
      {"[1]", "is not of the form"},
      {"{\"captions\": []}", "\"clip\" is missing"},
      {"{\"clip\": 7}", "\"clip\" must be a text"},
      {"{\"clip\": \"\"}", "no name"},
      {"{\"clip\": \"a\", \"captions\": 1}", "list of texts"},
      {"{\"clip\": \"a\", \"caption\": \"b\"}", "\"caption\" is not read"},
      {"{\"clip\": \"a\", \"captions\": [1]}", "list of texts"},
      {"{\"clip\": \"a\", \"labels\": []}", "JSON object"},
      {"{\"clip\": \"a\", \"split\": \"dev\"}", "unknown split 'dev'"},
      {"{\"clip\": \"walk_1000\"}", "was given in line 1 already"},
      {deep.c_str(), "nested deeper than"}};
  for (const auto& [line, message] : cases) {
    write_file_atomically(folder / "walks.jsonl", good + line);
    db::Database fresh(folder / "fresh", db::OpenMode::create);
    const exchange::ImportReport report = exchange::import_folder(fresh, options);
    EXPECT_EQ(report.files_stored, 1) << message;
    EXPECT_TRUE(any_contains(report.warnings, "walks.jsonl:2: ")) << message;
    EXPECT_TRUE(any_contains(report.warnings, message)) << message;
    EXPECT_EQ(fresh.clip(*fresh.find_name("walk_1000")).captions.size(), 2u) << message;
    std::filesystem::remove(folder / "fresh");
  }
  // Where no line is of use, the file is another one.
  write_file_atomically(folder / "walks.jsonl", "clip,caption\na,b\n");
  const std::string error = error_of([&] { exchange::import_folder(database, options); });
  EXPECT_NE(error.find("walks.jsonl:1: is not JSON"), std::string::npos) << error;
  EXPECT_EQ(database.clip_count(), 0);
}

TEST(ImportCaptions, CaptionsOfWindowsAreRead) {
  TestFolder folder;
  const exchange::ImportOptions options = make_walks(folder, 1, ".npy");
  std::string line = caption_line("walk_1000");
  line.insert(line.size() - 1, "\r");
  write_file_atomically(folder / "walks.jsonl", "\xEF\xBB\xBF" + line);
  db::Database database(folder / "d", db::OpenMode::create);
  EXPECT_TRUE(exchange::import_folder(database, options).warnings.empty());
  EXPECT_EQ(database.clip(*database.find_name("walk_1000")).split, "train");
}

TEST(ImportCaptions, OtherSpellingsMeanTheSame) {
  TestFolder folder;
  const exchange::ImportOptions options = make_walks(folder, 2, ".npy");
  // Lines that end with CR, one caption without a list, file names, and Windows-1252.
  write_file_atomically(folder / "walks.jsonl",
                        "{\"clip\": \"walk_1000.npy\", \"captions\": \"to the caf\xE9\"}\r"
                        "{\"clip\": \"walk_1001\", \"captions\": [\"b\"]}\r");
  db::Database database(folder / "d", db::OpenMode::create);
  EXPECT_TRUE(exchange::import_folder(database, options).warnings.empty());
  EXPECT_EQ(database.clip(*database.find_name("walk_1000")).captions,
            std::vector<std::string>{"to the caf\xC3\xA9"});
  EXPECT_EQ(database.clip(*database.find_name("walk_1001")).captions,
            std::vector<std::string>{"b"});
}

}  // namespace
}  // namespace remomask
