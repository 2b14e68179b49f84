#include <gtest/gtest.h>

#include <fstream>

#include "base/file.h"
#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

class CheckCommandTest : public testing::Test {
 protected:
  void SetUp() override {
    run_json({"procedural", "--db", database_, "--count", "4"});
    run_json({"index", database_});
  }

  /// Replaces the last of these bytes in a file.
  static void damage(const std::string& path, const std::string& bytes) {
    std::string content = read_file(path);
    const size_t at = content.rfind(bytes);
    ASSERT_NE(at, std::string::npos) << path;
    content[at] = static_cast<char>(content[at] ^ 1);
    std::ofstream(path, std::ios::binary) << content;
  }

  TestFolder folder_;
  std::string database_ = folder_ / "d.sqlite";
};

TEST_F(CheckCommandTest, SaysWhatIsInOrder) {
  const nlohmann::json files = run_json({"check", database_, database_ + ".index"}).at("files");
  EXPECT_EQ(files[0].at("kind"), "database");
  EXPECT_EQ(files[1].at("kind"), "index");
  EXPECT_EQ(files[1].at("content"), "4 clips");
  for (const auto& file : files) {
    EXPECT_TRUE(file.at("defects").empty());
    EXPECT_TRUE(file.at("checksums"));
  }
}

TEST_F(CheckCommandTest, NamesEveryDamagedFileAndFails) {
  damage(database_, "\"content\"");
  damage(database_ + ".index", "RMMINDEX");
  const std::string absent = folder_ / "absent.safetensors";
  const ProgramResult result = run_program({"check", database_, database_ + ".index", absent});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.output.find(database_ + ": page "), std::string::npos) << result.output;
  EXPECT_NE(result.output.find(database_ + ": clip "), std::string::npos) << result.output;
  EXPECT_NE(result.output.find(database_ + ".index: "), std::string::npos) << result.output;
  EXPECT_NE(result.output.find(absent + ": there is no such file"), std::string::npos);
  EXPECT_NE(result.errors.find("3 of 3 files damaged"), std::string::npos) << result.errors;
}

}  // namespace
}  // namespace remomask
