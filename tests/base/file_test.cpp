#include "base/file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "base/bounded_file.h"
#include "base/hash.h"
#include "remomask/error.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

class FileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("remomask_file_test_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  size_t file_count() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), {}));
  }
  fs::path folder_;
};

TEST_F(FileTest, ReadsNoMoreThanTheLimit) {
  const std::string content(10'000, 'x');
  write_file_atomically(path("a"), content);
  EXPECT_EQ(read_bounded_file(path("a"), 10'000), content);
  EXPECT_THROW(read_bounded_file(path("a"), 9'999), FileError);
  EXPECT_THROW(read_bounded_file("/dev/zero", 10'000'000), FileError);
  EXPECT_EQ(read_bounded_file("/dev/null", 0), "");
  EXPECT_FALSE(read_bounded_file("/proc/self/status", 1'000'000).empty());
}

TEST_F(FileTest, WritesAndReadsBackEveryByte) {
  std::string content;
  for (int i = 0; i < 70000; ++i) content += static_cast<char>(i * 7);
  write_file_atomically(path("a"), content);
  EXPECT_EQ(read_file(path("a")), content);
  write_file_atomically(path("a"), "");
  EXPECT_EQ(read_file(path("a")), "");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(FileTest, APipeIsReadAndOneWithoutAWriterIsRefused) {
  const std::string pipe = path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::ofstream stream(pipe);
    // Longer than a look for a writer takes.
    std::this_thread::sleep_for(std::chrono::milliseconds(3500));
    stream << std::string(100000, 'x') << "end";
  });
  EXPECT_EQ(read_file(pipe), std::string(100000, 'x') + "end");
  writer.join();
  try {
    read_file(pipe);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("pipe into which nothing writes"), std::string::npos);
  }
}

TEST_F(FileTest, MissingFilesAndFoldersAreNamed) {
  EXPECT_THROW(read_file(path("missing")), FileError);
  EXPECT_THROW(read_file(folder_.string()), FileError);
  try {
    write_file_atomically(path("no/such/folder"), "x");
    FAIL() << "no error";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("folder does not exist"), std::string::npos);
  }
}

TEST_F(FileTest, UncommittedFileLeavesTheOldOneAndNoRest) {
  write_file_atomically(path("a"), "old");
  {
    AtomicFile file(path("a"));
    std::ofstream(file.temporary_path()) << "new";
  }
  EXPECT_EQ(read_file(path("a")), "old");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(FileTest, FullDiskKeepsTheOldContent) {
  write_file_atomically(path("a"), "old");
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    // A limit on the size of files fails a write just as a full disk does.
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_file_atomically(path("a"), std::string(5000, 'n'));
    } catch (const FileError&) {
      ::_exit(7);
    }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_EQ(read_file(path("a")), "old");
  EXPECT_EQ(file_count(), 1u);
}

TEST(FileErrorTest, SaysPathAndLine) {
  EXPECT_STREQ(FileError("clip.bvh", 12, "bad number").what(), "clip.bvh:12: bad number");
  EXPECT_STREQ(FileError("clip.bvh", 0, "truncated").what(), "clip.bvh: truncated");
}

TEST(HashTest, KnownValueOfTheSpecification) {
  // XXH3 128 of the empty input, from the reference implementation's own test vectors.
  EXPECT_EQ(content_hash(""), "99aa06d3014798d86001c324468d497f");
  EXPECT_NE(content_hash("a"), content_hash("b"));
}

}  // namespace
}  // namespace remomask
