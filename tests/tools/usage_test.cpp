#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

const std::vector<std::string> kCommands = {"generate", "search",  "import", "index",      "train",
                                            "evaluate", "convert", "sheet",  "procedural", "info",
                                            "db",       "edit",    "ablate", "skeleton"};

TEST(UsageTest, HelpNamesEveryCommandAndEachHasAnExample) {
  const ProgramResult help = run_program({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  for (const std::string& command : kCommands) {
    EXPECT_NE(help.output.find("\n  " + command), std::string::npos) << command;
    const ProgramResult own = run_program({command, "--help"});
    EXPECT_EQ(own.exit_code, 0) << command;
    EXPECT_NE(own.output.find("Example:\n  remomask " + command), std::string::npos) << own.output;
  }
}

TEST(UsageTest, WrongUsageEndsWithTwo) {
  EXPECT_EQ(run_program({}).exit_code, 2);
  EXPECT_EQ(run_program({"dance"}).exit_code, 2);
  EXPECT_EQ(run_program({"info"}).exit_code, 2);
  EXPECT_EQ(run_program({"search", "walk", "--no-such-option"}).exit_code, 2);
  EXPECT_EQ(run_program({"search", "walk", "-k", "0"}).exit_code, 2);
  EXPECT_EQ(run_program({"--device", "cuda", "info", "x.sqlite"}).exit_code, 2);
  EXPECT_EQ(run_program({"--threads", "-3", "info", "x.sqlite"}).exit_code, 2);
}

// What a user can break, and what the message must name.
struct BrokenCase {
  std::vector<std::string> arguments;
  std::string expected;
};

TEST(UsageTest, BadInputEndsWithOneAndSaysWhatToDo) {
  const TestFolder scratch;
  const auto write = [&](const std::string& name, const std::string& content) {
    write_file_atomically(scratch / name, content);
    return scratch / name;
  };
  const std::string garbage = write("garbage.sqlite", std::string(5000, 'x'));
  const std::string model = write("garbage.safetensors", "no model");
  const std::string bvh = write("broken.bvh", "HIERARCHY\nROOT hip\n{\n  OFFSET 0 zero 0\n");
  const std::string text = write("notes.txt", "hello");
  const std::string missing = scratch / "missing.sqlite";
  std::filesystem::create_directory(scratch / "empty");
  const std::vector<BrokenCase> cases = {
      {{"info", missing}, "missing.sqlite"},
      {{"info", garbage}, "garbage.sqlite"},
      {{"info", model}, "garbage.safetensors"},
      {{"convert", bvh, scratch / "o.npy"}, "broken.bvh:4"},
      {{"convert", text, scratch / "o.npy"}, "notes.txt"},
      {{"convert", scratch / "no.bvh", scratch / "o.npy"}, "no.bvh"},
      {{"import", scratch / "empty", "--db", scratch / "new.sqlite"}, "empty"},
      {{"search", "walk", "--db", missing}, "missing.sqlite"},
      {{"search", "walk", "--model", model}, "garbage.safetensors"},
      {{"generate", "walk", "-o", scratch / "no/folder/o.bvh"}, "folder"},
      {{"generate", "walk", "-o", scratch / "o.abc"}, "o.abc"},
      {{"generate", "   ", "-o", scratch / "o.bvh"}, "empty"},
  };
  for (const BrokenCase& broken : cases) {
    const ProgramResult result = run_program(broken.arguments);
    EXPECT_EQ(result.exit_code, 1) << broken.expected << "\n" << result.errors;
    EXPECT_NE(result.errors.find(broken.expected), std::string::npos) << result.errors;
    EXPECT_EQ(result.output, "") << broken.expected;
  }
}

TEST(Usage, WrongWordsAreAnsweredWithWhatWasMeant) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"genrate", "a walk"}, "did you mean \"generate\"?"},
      {{"db", "lst", "x.sqlite"}, "did you mean \"list\"?"},
      {{"generate", "a walk", "--secnds", "3", "-o", "x.bvh"}, "did you mean --seconds?"},
      {{"generate", "a", "person", "waves", "-o", "x.bvh"}, "put the sentence in quotes"},
      {{"search", "walk", "-k", "0"}, "must be at least 1, not 0"},
      {{"generate", "walk", "--top", "3", "-o", "x.bvh"}, "must be from 0 to 1, not 3"},
      {{"generate", "walk", "-n", "5000", "-o", "x.bvh"}, "must be from 1 to 1000, not 5000"},
      {{"convert", "a.bvh", "b.npy", "--metres-per-unit", "0"}, "must be greater than 0, not 0"},
      {{"--threads", "-3", "info", "x.sqlite"}, "must be at least 0, not -3"},
  };
  for (const auto& [arguments, expected] : cases) {
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 2) << expected;
    EXPECT_NE(result.errors.find(expected), std::string::npos) << result.errors;
    EXPECT_LT(result.errors.size(), 300u) << result.errors;
  }
}

TEST(Usage, ErrorsAreJsonWhereAnswersAre) {
  const auto error_of = [](const std::vector<std::string>& arguments) {
    return nlohmann::json::parse(run_program(arguments).output).at("error");
  };
  const auto usage = error_of({"--json", "generate", "a walk", "--secnds", "3", "-o", "x.bvh"});
  EXPECT_EQ(usage.at("code"), 2);
  EXPECT_EQ(usage.at("kind"), "usage");
  const auto file = error_of({"--json", "info", "absent.safetensors"});
  EXPECT_EQ(file.at("code"), 1);
  EXPECT_EQ(file.at("kind"), "file");
  EXPECT_EQ(file.at("path"), "absent.safetensors");
}

TEST(Usage, AFullOutputIsAFailure) {
  for (const char* arguments : {"--version", "--help", "--json genrate", "--json info absent"}) {
    const std::string command =
        std::string("'" REMOMASK_PROGRAM "' ") + arguments + " >/dev/full 2>/dev/null";
    const int status = std::system(command.c_str());
    ASSERT_TRUE(WIFEXITED(status)) << arguments;
    EXPECT_NE(WEXITSTATUS(status), 0) << arguments;
  }
}

TEST(Usage, HelpKeepsLimitsOutOfItsColumns) {
  const std::string text = run_program({"db", "export", "--help"}).output;
  EXPECT_NE(text.find("--format {bvh,npy,"), std::string::npos) << text;
  for (const char* noise : {"ENUM", "Excludes", "->", "INT:"}) {
    EXPECT_EQ(text.find(noise), std::string::npos) << noise << "\n" << text;
  }
}

TEST(Usage, ADamagedDatabaseIsAnsweredWithOneDocument) {
  const TestFolder folder;
  const std::string database = folder / "motions.sqlite";
  run_json({"procedural", "--db", database, "--count", "4"});
  std::fstream file(database, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(std::filesystem::file_size(database)) - 2000);
  file << std::string(1500, 'x');
  file.close();
  const ProgramResult result = run_program({"--json", "--quiet", "db", "check", database});
  EXPECT_EQ(result.exit_code, 1) << result.errors;
  EXPECT_TRUE(nlohmann::json::accept(result.output)) << result.output;
}

TEST(Usage, MakingMotionsStopsSoon) {
  const TestFolder folder;
  const auto begin = std::chrono::steady_clock::now();
  const ProgramResult result =
      run_program({"procedural", "--db", folder / "many.sqlite", "--count", "100000"}, {},
                  /*kill_after_seconds=*/1, SIGINT);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(4));
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  EXPECT_NE(result.errors.find("nothing was stored"), std::string::npos) << result.errors;
  EXPECT_FALSE(std::filesystem::exists(folder / "many.sqlite"));
}

TEST(Usage, HelpVersionAndMistakesLoadNoNetwork) {
  for (const char* arguments : {"--version", "--help", "generate --help", "genrate"}) {
    const std::string command = std::string("LD_DEBUG=files '" REMOMASK_PROGRAM "' ") + arguments +
                                " 2>&1 | grep -q 'libtorch[^ ]*\\.so\\|remomask-core\\.so'";
    EXPECT_NE(std::system(command.c_str()), 0) << arguments;
  }
}

TEST(Usage, ShippedFilesComeFromTheChosenFolderOrAreMissed) {
  const ProgramResult result = run_program({"search", "walk"}, {{"REMOMASK_MODELS", "/nowhere"}});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.errors.find("REMOMASK_MODELS names the folder \"/nowhere\""), std::string::npos)
      << result.errors;
}

TEST(Usage, AnInterruptedGenerationEndsSoonWithItsStatus) {
  const TestFolder folder;
  const ProgramResult result = run_program(
      {"generate", "a person walks around", "--seconds", "600", "-o", folder / "long.npy"}, {},
      /*kill_after_seconds=*/4, SIGINT);
  EXPECT_EQ(result.exit_code, 130) << result.errors;
  EXPECT_NE(result.errors.find("stopped"), std::string::npos) << result.errors;
  EXPECT_FALSE(std::filesystem::exists(folder / "long.npy"));
}

TEST(Usage, TheInputIsNotReplacedUnasked) {
  const TestFolder folder;
  const std::string walk = folder / "walk.npy";
  ASSERT_EQ(run_program({"generate", "a person walks", "--seconds", "2", "-o", walk}).exit_code, 0);
  const std::string before = read_file(walk);
  const ProgramResult refused = run_program({"convert", walk, walk});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.errors.find("--force"), std::string::npos) << refused.errors;
  EXPECT_EQ(read_file(walk), before);
  EXPECT_EQ(run_program({"convert", walk, walk, "--force"}).exit_code, 0);
  const ProgramResult again =
      run_program({"generate", "a person walks", "--seconds", "2", "-o", walk});
  EXPECT_NE(again.errors.find("exists and is replaced"), std::string::npos) << again.errors;
}

}  // namespace
}  // namespace remomask
