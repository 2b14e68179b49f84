// Kills every command that writes at its calls that change files, and lets the disk be full from a
// write on. Afterwards the files are in order, the same command run again gives what an undisturbed
// run gives, and nothing is left over.
//   REMOMASK_TORTURE_POINTS=N   faults a command and kind; 0: at every call. Default 2, and 1 of
//                               commands that generate or train.
#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>

#include "base/file.h"
#include "tests/tools/program_runner.h"
#include "tests/torture/folder_state.h"
#include "tests/torture/scenarios.h"
#include "tests/torture/shared_folder.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

class Torture : public testing::TestWithParam<Scenario> {
 protected:
  static void TearDownTestSuite() {
    std::cout << "torture: " << kills_ << " kills and " << full_disks_ << " full disks\n";
  }

  void SetUp() override {
    if (GetParam().generates) SharedFolder::instance().need_model();
    prepare(start_ / "work");
    fs::copy(start_ / "work", reference_ / "work", fs::copy_options::recursive);
    const std::string count = start_ / "calls";
    auto environment = interposed();
    environment["REMOMASK_CALLS"] = count;
    const ProgramResult run = run_program(command_in(reference_ / "work"), environment);
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    calls_ = std::stol(read_file(count));
    ASSERT_GT(calls_, 0);
    expected_ = state_of(reference_ / "work");
    ASSERT_EQ(damage_in(reference_ / "work"), "");
  }

  static Words command_in(const std::string& folder) {
    Words command = in_folders(GetParam().command, folder, SharedFolder::instance().path());
    command.push_back("--quiet");
    return command;
  }

  static std::map<std::string, std::string> interposed() {
    std::map<std::string, std::string> environment = {{"LD_PRELOAD", REMOMASK_INTERPOSE}};
    if (GetParam().clock_step > 0) {
      environment["REMOMASK_CLOCK_STEP"] = std::to_string(GetParam().clock_step);
    }
    return environment;
  }

  static void prepare(const std::string& folder) {
    fs::create_directories(folder);
    for (const Words& words : GetParam().before) {
      Words command = in_folders(words, folder, SharedFolder::instance().path());
      if (command.front() == "cp") {
        write_file_atomically(command[2], read_file(command[1]));
        continue;
      }
      command.push_back("--quiet");
      const ProgramResult run = run_program(command);
      ASSERT_EQ(run.exit_code, 0) << run.errors;
    }
  }

  /// Calls to fail at, spread over the run.
  std::vector<long> points() const {
    const char* text = std::getenv("REMOMASK_TORTURE_POINTS");
    long count = text != nullptr ? std::atol(text) : GetParam().generates ? 1 : 2;
    if (count == 0 || count > calls_) count = calls_;
    std::vector<long> result;
    for (long i = 0; i < count; ++i) result.push_back(1 + (2 * i + 1) * calls_ / (2 * count));
    return result;
  }

  void try_fault(const std::string& fault, long call) {
    SCOPED_TRACE(fault + " at call " + std::to_string(call) + " of " + std::to_string(calls_));
    const TestFolder scratch;
    const std::string folder = scratch / "work";
    fs::copy(start_ / "work", folder, fs::copy_options::recursive);
    auto environment = interposed();
    environment["REMOMASK_FAULT"] = fault;
    environment["REMOMASK_CALL"] = std::to_string(call);
    const ProgramResult broken = run_program(command_in(folder), environment);
    if (fault == "full") {
      // What was written before the disk was full can be all that there was to write.
      EXPECT_TRUE(broken.exit_code == 1 || broken.exit_code == 0) << broken.exit_code;
      EXPECT_EQ(leftovers_in(folder), "") << broken.errors;
      ++full_disks_;
    } else {
      EXPECT_TRUE(broken.exit_code == 137 || broken.exit_code == 0) << broken.exit_code;
      kills_ += broken.exit_code == 137 ? 1 : 0;
    }
    EXPECT_EQ(damage_in(folder), "");
    const ProgramResult again = run_program(command_in(folder));
    ASSERT_TRUE(again.exit_code == 0 || is_done_already(again)) << again.errors;
    EXPECT_EQ(state_of(folder), expected_);
    EXPECT_EQ(leftovers_in(folder), "");
  }

  /// The command was killed after its work: some say the second time that it is done.
  static bool is_done_already(const ProgramResult& run) {
    return run.errors.find("there is no clip") != std::string::npos ||
           run.errors.find("is the same motion") != std::string::npos ||
           run.errors.find("already") != std::string::npos;
  }

  static inline int kills_ = 0, full_disks_ = 0;
  TestFolder start_, reference_;
  long calls_ = 0;
  std::string expected_;
};

TEST_P(Torture, KilledCommandsLoseNothing) {
  for (const long call : points()) try_fault("kill", call);
}

TEST_P(Torture, FullDisksLoseNothing) {
  for (const long call : points()) try_fault("full", call);
}

INSTANTIATE_TEST_SUITE_P(Commands, Torture, testing::ValuesIn(scenarios()),
                         [](const auto& scenario) { return scenario.param.name; });

}  // namespace
}  // namespace remomask
