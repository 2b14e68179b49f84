// Kills every command that writes at its calls of write, fsync, rename and unlink, and lets the
// disk be full from a write on. Afterwards the database is in order, the same command run again
// gives what an undisturbed run gives, and nothing is left over.
//   REMOMASK_TORTURE_POINTS=N   faults a command and kind; 0: at every call. Default 3.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "base/file.h"
#include "base/hash.h"
#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

namespace fs = std::filesystem;

using Words = std::vector<std::string>;

/// A command that writes, and the files that it starts from. In its words, "@" stands for the
/// folder that it works in.
struct Scenario {
  const char* name;
  std::vector<Words> before;
  Words command;
  std::vector<std::string> databases;  ///< to be checked
};

const std::vector<Scenario>& scenarios() {
  static const Words few = {"procedural", "--db", "@/d.sqlite", "--count", "6"};
  static const Words index = {"index", "@/d.sqlite"};
  static const Words snapshot = {"db", "snapshot", "@/d.sqlite", "@/s.sqlite"};
  static const Words motion = {"convert", "@/a.npy", "@/b.bvh"};
  static const Words files = {"db", "export", "@/d.sqlite", "@/files"};
  static const std::vector<Scenario> all = {
      {"import", {few, files}, {"import", "@/files", "--db", "@/new.sqlite"}, {"new.sqlite"}},
      {"index", {few}, index, {"d.sqlite"}},
      {"add",
       {few, files},
       {"db", "add", "@/e.sqlite", "@/first.npy", "--caption", "a person"},
       {"e.sqlite"}},
      {"tag", {few}, {"db", "tag", "@/d.sqlite", "#1", "#2", "#4", "--add", "good"}, {"d.sqlite"}},
      {"remove", {few}, {"db", "remove", "@/d.sqlite", "#2", "#3", "--yes"}, {"d.sqlite"}},
      {"merge",
       {few, {"procedural", "--db", "@/e.sqlite", "--count", "3"}},
       {"db", "merge", "@/e.sqlite", "@/d.sqlite"},
       {"e.sqlite"}},
      {"snapshot",
       {few, snapshot},
       {"db", "snapshot", "@/d.sqlite", "@/s.sqlite", "--force"},
       {"s.sqlite"}},
      {"restore",
       {few, snapshot},
       {"db", "restore", "@/s.sqlite", "@/r.sqlite", "--force"},
       {"r.sqlite"}},
      {"export", {few}, {"db", "export", "@/d.sqlite", "@/files", "--resume"}, {}},
      {"convert", {few, files}, {"convert", "@/first.npy", "@/b.bvh"}, {}},
  };
  return all;
}

Words in_folder(const Words& words, const std::string& folder) {
  Words result;
  for (const std::string& word : words) {
    result.push_back(word.starts_with("@") ? folder + word.substr(1) : word);
  }
  result.push_back("--quiet");
  return result;
}

/// Everything that the program says of a database, or the hash of a file.
std::string state_of(const std::string& folder) {
  std::set<std::string> lines;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const std::string path = entry.path().string();
    const std::string name = fs::relative(path, folder).string();
    if (name.ends_with(".sqlite")) {
      nlohmann::json clips = run_json({"db", "list", path});
      lines.insert(name + ": " + clips.dump());
    } else if (name.find(".sqlite") == std::string::npos) {
      lines.insert(name + ": " + content_hash(read_file(path)));
    }
  }
  std::string state;
  for (const std::string& line : lines) state += line + "\n";
  return state;
}

/// Files of a killed process: none may be there after the next run.
std::string leftovers_in(const std::string& folder) {
  std::string found;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.find(".tmp-") != std::string::npos || name.ends_with("-journal")) found += name + " ";
  }
  return found;
}

class Torture : public testing::TestWithParam<Scenario> {
 protected:
  void SetUp() override {
    prepare(start_ / "work");
    fs::copy(start_ / "work", reference_ / "work", fs::copy_options::recursive);
    const std::string count = start_ / "calls";
    const ProgramResult run =
        run_program(in_folder(GetParam().command, reference_ / "work"),
                    {{"LD_PRELOAD", REMOMASK_INTERPOSE}, {"REMOMASK_CALLS", count}});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    calls_ = std::stol(read_file(count));
    ASSERT_GT(calls_, 0);
    expected_ = state_of(reference_ / "work");
  }

  static void prepare(const std::string& folder) {
    fs::create_directories(folder);
    for (const Words& words : GetParam().before) {
      const ProgramResult run = run_program(in_folder(words, folder));
      ASSERT_EQ(run.exit_code, 0) << run.errors;
    }
    if (!fs::exists(folder + "/files")) return;
    std::vector<std::string> motions;
    for (const auto& entry : fs::directory_iterator(folder + "/files")) {
      if (entry.path().extension() == ".npy") motions.push_back(entry.path().string());
    }
    fs::copy_file(*std::min_element(motions.begin(), motions.end()), folder + "/first.npy");
  }

  /// Calls to fail at, spread over the run.
  std::vector<long> points() const {
    const char* text = std::getenv("REMOMASK_TORTURE_POINTS");
    long count = text != nullptr ? std::atol(text) : 3;
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
    const Words command = in_folder(GetParam().command, folder);
    const ProgramResult broken = run_program(command, {{"LD_PRELOAD", REMOMASK_INTERPOSE},
                                                       {"REMOMASK_FAULT", fault},
                                                       {"REMOMASK_CALL", std::to_string(call)}});
    if (fault == "full") {
      // What was written before the disk was full can be all that there was to write.
      EXPECT_TRUE(broken.exit_code == 1 || broken.exit_code == 0) << broken.exit_code;
      EXPECT_EQ(leftovers_in(folder), "");
    } else {
      EXPECT_TRUE(broken.exit_code == 137 || broken.exit_code == 0) << broken.exit_code;
    }
    for (const std::string& name : GetParam().databases) {
      const std::string path = folder + "/" + name;
      // A new database whose first transaction was never finished is an empty file.
      if (!fs::exists(path) || fs::file_size(path) == 0) continue;
      if (is_unmade(path)) continue;
      const ProgramResult check = run_program({"db", "check", path});
      EXPECT_EQ(check.exit_code, 0) << check.output << check.errors;
    }
    const ProgramResult again = run_program(command);
    ASSERT_TRUE(again.exit_code == 0 || is_done_already(again)) << again.errors;
    EXPECT_EQ(state_of(folder), expected_);
    EXPECT_EQ(leftovers_in(folder), "");
  }

  /// True for a file in which no table was made yet.
  static bool is_unmade(const std::string& path) {
    return run_program({"db", "check", path}).errors.find("it is empty") != std::string::npos;
  }

  /// The command was killed after its work: some say the second time that it is done.
  static bool is_done_already(const ProgramResult& run) {
    return run.errors.find("there is no clip") != std::string::npos ||
           run.errors.find("is the same motion") != std::string::npos ||
           run.errors.find("already") != std::string::npos;
  }

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
