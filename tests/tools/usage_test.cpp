#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/file.h"
#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

const std::vector<std::string> kCommands = {"generate", "search",  "import", "index",      "train",
                                            "evaluate", "convert", "sheet",  "procedural", "info",
                                            "db",       "edit",    "ablate"};

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
  const ScratchFolder scratch;
  const auto write = [&](const std::string& name, const std::string& content) {
    write_file_atomically(scratch.path(name), content);
    return scratch.path(name);
  };
  const std::string garbage = write("garbage.sqlite", std::string(5000, 'x'));
  const std::string model = write("garbage.safetensors", "no model");
  const std::string bvh = write("broken.bvh", "HIERARCHY\nROOT hip\n{\n  OFFSET 0 zero 0\n");
  const std::string text = write("notes.txt", "hello");
  const std::string missing = scratch.path("missing.sqlite");
  std::filesystem::create_directory(scratch.path("empty"));
  const std::vector<BrokenCase> cases = {
      {{"info", missing}, "missing.sqlite"},
      {{"info", garbage}, "garbage.sqlite"},
      {{"info", model}, "garbage.safetensors"},
      {{"convert", bvh, scratch.path("o.npy")}, "broken.bvh:4"},
      {{"convert", text, scratch.path("o.npy")}, "notes.txt"},
      {{"convert", scratch.path("no.bvh"), scratch.path("o.npy")}, "no.bvh"},
      {{"import", scratch.path("empty"), "--db", scratch.path("new.sqlite")}, "empty"},
      {{"search", "walk", "--db", missing}, "missing.sqlite"},
      {{"search", "walk", "--model", model}, "garbage.safetensors"},
      {{"generate", "walk", "-o", scratch.path("no/folder/o.bvh")}, "folder"},
      {{"generate", "walk", "-o", scratch.path("o.fbx")}, "o.fbx"},
      {{"generate", "   ", "-o", scratch.path("o.bvh")}, "empty"},
  };
  for (const BrokenCase& broken : cases) {
    const ProgramResult result = run_program(broken.arguments);
    EXPECT_EQ(result.exit_code, 1) << broken.expected << "\n" << result.errors;
    EXPECT_NE(result.errors.find(broken.expected), std::string::npos) << result.errors;
    EXPECT_EQ(result.output, "") << broken.expected;
  }
}

}  // namespace
}  // namespace remomask
