// The ablation with the program itself, on motions that it makes.
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>

#include "base/file.h"
#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

class AblateTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TestFolder;
    run_json({"procedural", "--db", path("motions.sqlite"), "--count", "60"});
    const ProgramResult trained = run_program({"--quiet", "--threads", "1", "train", "evaluator",
                                               "--db", path("motions.sqlite"), "--preset", "tiny",
                                               "--steps", "4", "-o", path("judge")});
    ASSERT_EQ(trained.exit_code, 0) << trained.errors;
  }
  static void TearDownTestSuite() {
    delete scratch_;
    scratch_ = nullptr;
  }

  static std::string path(const std::string& name) { return *scratch_ / name; }

  static std::vector<std::string> arguments(const std::string& folder) {
    std::vector<std::string> words = {"--threads", "1", "ablate", "-o", path(folder)};
    const std::vector<std::pair<std::string, std::string>> options = {
        {"--db", path("motions.sqlite")},
        {"--evaluator", path("judge/evaluator.safetensors")},
        {"--variants", "full,no-ssta"},
        {"--steps", "3"},
        {"--batch", "4"},
        {"--prompts", "5"},
        {"--steps-sweep", "2"}};
    for (const auto& [option, value] : options) {
      words.push_back(option);
      words.push_back(value);
    }
    return words;
  }

 private:
  static TestFolder* scratch_;
};

TestFolder* AblateTest::scratch_ = nullptr;

TEST_F(AblateTest, KilledRunGoesOnToTheSameTable) {
  auto dry = arguments("straight");
  dry.push_back("--dry-run");
  const auto plan = run_json(dry);
  // Retriever, tokenizer, residual once, two masked transformers, three trials.
  EXPECT_EQ(plan["jobs"].size(), 8u);
  for (const auto& job : plan["jobs"]) EXPECT_EQ(job["done"], false);
  const auto straight = run_json(arguments("straight"));
  for (const auto& job : run_json(dry)["jobs"]) EXPECT_EQ(job["done"], true);
  ASSERT_EQ(straight["variants"].size(), 2u);
  EXPECT_EQ(straight["variants"][1]["name"], "no-ssta");
  EXPECT_EQ(straight["variants"][0]["seeds"][0]["figures"]["all"]["prompts"], 5);
  EXPECT_EQ(straight["sweeps"]["steps"].size(), 1u);
  EXPECT_EQ(read_file(path("straight/ablation.png")).substr(1, 3), "PNG");
  EXPECT_EQ(read_file(path("straight/ablation_sweeps.png")).substr(1, 3), "PNG");

  ProgramResult result;
  int rounds = 0;
  do {
    const bool kill = rounds % 2 == 1;
    result = run_program(arguments("killed"), {}, rounds < 4 ? 1.5 : 0, kill ? SIGKILL : SIGINT);
    ++rounds;
  } while (result.exit_code != 0 && rounds < 10);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_GT(rounds, 1);
  EXPECT_EQ(result.output, read_file(path("straight/ablation.md")));
  EXPECT_EQ(read_file(path("killed/ablation.json")), read_file(path("straight/ablation.json")));

  // A further run trains nothing and writes into the docs on demand.
  fs::create_directory(path("docs"));
  write_file_atomically(path("docs/results.md"),
                        "before\n<!-- ablation:begin -->\nold\n<!-- ablation:end -->\nafter\n");
  auto documented = arguments("straight");
  documented.insert(documented.end(), {"--write-docs", path("docs")});
  run_json(documented);
  const std::string page = read_file(path("docs/results.md"));
  EXPECT_EQ(page.find("old"), std::string::npos);
  EXPECT_NE(page.find(read_file(path("straight/ablation.md"))), std::string::npos);
  EXPECT_EQ(page.substr(page.size() - 6), "after\n");
  EXPECT_TRUE(fs::exists(path("docs/ablation.png")));
}

TEST_F(AblateTest, WrongChoicesAreErrors) {
  const auto failing = [&](std::vector<std::string> more, const std::string& named) {
    auto words = arguments("wrong");
    words.insert(words.end(), more.begin(), more.end());
    const ProgramResult result = run_program(words);
    EXPECT_EQ(result.exit_code, 1) << named;
    EXPECT_NE(result.errors.find(named), std::string::npos) << result.errors;
  };
  failing({"--steps", "dance=3"}, "dance");
  failing({"--steps", "many"}, "--steps many");
  failing({"--seeds", "1,1"}, "seed");
  failing({"--split", "nowhere"}, "nowhere");
  EXPECT_FALSE(fs::exists(path("wrong/stages")));
}

}  // namespace
}  // namespace remomask
