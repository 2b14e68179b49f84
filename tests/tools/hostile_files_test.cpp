// Files that are made to exhaust the memory, or to keep a command waiting for ever: a clear error,
// soon, in less than 1 GB.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kGigabyte = uint64_t{1} << 30;

class HostileFiles : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& content) {
    std::ofstream(scratch_ / name, std::ios::binary) << content;
    return scratch_ / name;
  }
  /// Zeros that take no room on the disk follow the content.
  std::string sparse(const std::string& name, const std::string& content, uint64_t bytes) {
    file(name, content);
    fs::resize_file(scratch_ / name, bytes);
    return scratch_ / name;
  }
  static std::string repeated(const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
  }
  static std::string with_length(const std::string& header) {
    const uint64_t length = header.size();
    return std::string(reinterpret_cast<const char*>(&length), sizeof length) + header;
  }
  std::string sound_motion(const std::string& name) {
    fs::copy_file(REMOMASK_SOURCE_DIR "/tests/fuzz/corpus/npy/positions.npy", scratch_ / name);
    return scratch_ / name;
  }

  /// `says`: part of the message.
  static void expect_refused(const std::vector<std::string>& arguments, const std::string& says) {
    const ProgramResult run = run_program(arguments, {}, 0);
    EXPECT_EQ(run.exit_code, 1) << arguments.front() << run.errors;
    EXPECT_NE((run.errors + run.output).find(says), std::string::npos) << run.errors << run.output;
    EXPECT_LT(run.peak_megabytes, 1000) << arguments.front() << " " << arguments.back();
  }

  TestFolder scratch_;
};

TEST_F(HostileFiles, HeadersOfMillionsOfValues) {
  const std::string path =
      file("a.safetensors", with_length("{\"a\":[" + repeated("{},", 20000000) + "{}]}"));
  expect_refused({"check", path}, "two million values");
  expect_refused({"info", path}, "two million values");
}

TEST_F(HostileFiles, TensorsThatNobodyAskedFor) {
  std::string header = R"({"a":{"dtype":"U8","shape":[2147483648],"data_offsets":[0,2147483648]}})";
  header.resize(header.size() + (8 - header.size() % 8) % 8, ' ');
  const std::string path =
      sparse("a.safetensors", with_length(header), 8 + header.size() + 2 * kGigabyte);
  expect_refused({"info", path}, "not a remomask model");
  expect_refused({"search", "walk", "--text", path}, "not a remomask model");
  // It is in order as far as can be seen.
  const ProgramResult check = run_program({"check", path});
  EXPECT_EQ(check.exit_code, 0) << check.errors;
  EXPECT_LT(check.peak_megabytes, 1000);
}

TEST_F(HostileFiles, TextsOfGigabytes) {
  expect_refused({"check", sparse("a.bvh", "HIERARCHY\n", kGigabyte - 1)}, "holds more than");
  const std::string motion = sound_motion("b.npy");
  // A file of joints alone needs no map.
  const std::string joints = REMOMASK_SOURCE_DIR "/tests/fuzz/corpus/bvh/odd.bvh";
  expect_refused({"convert", joints, scratch_ / "c.npy", "--skeleton-map",
                  sparse("map.json", "[", 2 * kGigabyte)},
                 "holds more than");
  sparse("b.npy.json", "{", 2 * kGigabyte);
  expect_refused({"check", motion}, "holds more than");
  file("b.npy.json", "{\"a\":[" + repeated("[],", 20000000) + "[]]}");
  expect_refused({"check", motion}, "two million values");
  expect_refused({"generate", "--script", sparse("script.txt", "3 walk\n", kGigabyte), "-o",
                  scratch_ / "d.npy"},
                 "holds more than");
}

TEST_F(HostileFiles, PipesWithoutAWriter) {
  for (const char* name : {"a.bvh", "a.safetensors", "a.sqlite"}) {
    ASSERT_EQ(::mkfifo((scratch_ / name).c_str(), 0600), 0);
  }
  expect_refused({"convert", scratch_ / "a.bvh", scratch_ / "c.npy"}, "is a pipe");
  expect_refused({"check", scratch_ / "a.safetensors"}, "is not a regular file");
  expect_refused({"info", scratch_ / "a.safetensors"}, "cannot open");
  expect_refused({"db", "list", scratch_ / "a.sqlite"}, "is not a regular file");
}

TEST_F(HostileFiles, DatabasesOfHoles) {
  expect_refused({"check", sparse("a.sqlite", "SQLite format 3", 2 * kGigabyte)}, "a.sqlite");
  run_json({"procedural", "--db", scratch_ / "b.sqlite", "--count", "2"});
  fs::resize_file(scratch_ / "b.sqlite", 2 * kGigabyte);
  const ProgramResult check = run_program({"check", scratch_ / "b.sqlite"});
  EXPECT_LT(check.peak_megabytes, 1000);
}

}  // namespace
}  // namespace remomask
