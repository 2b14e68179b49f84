// Runs what pages in docs/ show: a page whose commands have gone stale fails.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "base/file.h"
#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

const std::string kDocs = REMOMASK_SOURCE_DIR "/docs/";
const std::string kPage = kDocs + "search.md";
const std::string kExample = REMOMASK_SOURCE_DIR "/examples/search/main.cpp";
const std::string kModels = REMOMASK_SOURCE_DIR "/models";

struct Block {
  std::string language, text;
  int line = 0;  ///< of the first line inside
};

std::vector<Block> code_blocks(const std::string& page) {
  std::vector<Block> blocks;
  std::istringstream lines(page);
  bool inside = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) blocks.push_back({line.substr(3), "", number + 1});
    } else if (inside) {
      blocks.back().text += line + "\n";
    }
  }
  EXPECT_FALSE(inside) << "a block has no end";
  return blocks;
}

/// Exit status of a shell that runs `script` in `folder`; its output into `log`.
int run_shell(const std::string& script, const std::string& folder, std::string& log) {
  const TestFolder scratch;
  const std::string file = scratch / "block.sh", output = scratch / "log";
  const std::string programs = fs::path(REMOMASK_PROGRAM).parent_path().string();
  write_file_atomically(file, "export PATH=\"" + programs + ":$PATH\"\nexport REMOMASK_MODELS=\"" +
                                  kModels + "\"\ncd \"" + folder + "\"\n" + script);
  const int status = std::system(("sh -eux '" + file + "' >'" + output + "' 2>&1").c_str());
  log = read_file(output);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class DocsPage : public ::testing::TestWithParam<const char*> {
 protected:
  std::string page() const { return kDocs + GetParam(); }
};
INSTANTIATE_TEST_SUITE_P(Pages, DocsPage,
                         ::testing::Values("search.md", "generation.md", "editing.md"));

TEST_P(DocsPage, EveryCommandRuns) {
  const TestFolder scratch;
  int run = 0;
  for (const Block& block : code_blocks(read_file(page()))) {
    if (block.language != "sh") continue;
    std::string log;
    ASSERT_EQ(run_shell(block.text, scratch.path(), log), 0) << page() << ":" << block.line << "\n"
                                                             << log;
    ++run;
  }
  EXPECT_GT(run, 5);
}

TEST_P(DocsPage, KnowsNoOtherKindsOfBlocks) {
  for (const Block& block : code_blocks(read_file(page()))) {
    EXPECT_TRUE(block.language == "sh" || block.language == "cpp")
        << page() << ":" << block.line << ": blocks in '" << block.language << "' are not tested";
  }
}

TEST(SearchPage, ShowsTheExampleAsItIs) {
  const std::string example = read_file(kExample);
  for (const Block& block : code_blocks(read_file(kPage))) {
    if (block.language != "cpp") continue;
    std::istringstream lines(block.text);
    size_t place = 0;
    for (std::string line; std::getline(lines, line);) {
      place = example.find(line, place);
      ASSERT_NE(place, std::string::npos) << kExample << " lacks: " << line;
    }
  }
}

TEST(SearchSample, FindsInTheShippedDatabase) {
  const TestFolder scratch;
  std::string log;
  const std::string example = "'" REMOMASK_SAMPLE "' ";
  ASSERT_EQ(run_shell(example + "$REMOMASK_MODELS/base.safetensors "
                                "$REMOMASK_MODELS/motions.sqlite 'a person jumps'",
                      scratch.path(), log),
            0)
      << log;
  const size_t first = log.find("1. ");
  ASSERT_NE(first, std::string::npos) << log;
  EXPECT_NE(log.substr(first, log.find('\n', first) - first).find("jump"), std::string::npos)
      << log;
  EXPECT_EQ(run_shell(example, scratch.path(), log), 2);
  EXPECT_EQ(run_shell(example + "nothing nowhere walk", scratch.path(), log), 1);
  EXPECT_NE(log.find("nothing"), std::string::npos);
}

}  // namespace
}  // namespace remomask
