#include "base/leftovers.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/file.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

/// The tag of a process that has ended.
std::string dead_tag() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  const std::string own = process_tag();
  return own.substr(0, own.find('-') + 1) + std::to_string(child);
}

TEST(Leftovers, OnlyThoseOfEndedProcessesOfThisMachineAreRemoved) {
  const fs::path folder = fs::path(testing::TempDir()) / ("leftovers" + process_tag());
  fs::create_directories(folder);
  const std::string dead = dead_tag();
  const auto touch = [&](const std::string& name) {
    std::ofstream(folder / name) << "x";
    return folder / name;
  };
  const fs::path kept[] = {touch("a.bvh"), touch("a.bvh.tmp-" + process_tag()),
                           touch("a.bvh.tmp-00000000-" + dead.substr(dead.find('-') + 1)),
                           touch("a.bvh.tmp-12"), touch("a.bvh.tmp-" + dead + "x")};
  const fs::path removed[] = {touch("a.bvh.tmp-" + dead), touch("b.tmp-" + dead + "-journal")};
  write_file_atomically((folder / "new.txt").string(), "new");
  for (const fs::path& path : kept) EXPECT_TRUE(fs::exists(path)) << path;
  for (const fs::path& path : removed) EXPECT_FALSE(fs::exists(path)) << path;
  fs::remove_all(folder);
}

}  // namespace
}  // namespace remomask
