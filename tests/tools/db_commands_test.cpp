#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

const std::vector<std::string> kDbCommands = {"info",    "list",    "show",     "add",   "tag",
                                              "remove",  "merge",   "export",   "check", "snapshot",
                                              "restore", "upgrade", "attribute"};

class DbCommandsTest : public testing::Test {
 protected:
  void SetUp() override {
    run_json({"procedural", "--db", database_, "--count", "12"});
    clips_ = run_json({"db", "list", database_})["clips"];
    ASSERT_EQ(clips_.size(), 12u);
  }
  std::string name(size_t i) const { return clips_[i]["name"]; }
  size_t count(std::vector<std::string> filters) const {
    filters.insert(filters.begin(), {"db", "list", database_});
    return run_json(filters)["clips"].size();
  }

  TestFolder scratch_;
  std::string database_ = scratch_ / "d.sqlite";
  nlohmann::json clips_;
};

TEST(DbUsage, EveryCommandHasHelpWithAnExample) {
  const ProgramResult group = run_program({"db", "--help"});
  EXPECT_EQ(group.exit_code, 0);
  for (const std::string& command : kDbCommands) {
    EXPECT_NE(group.output.find("\n  " + command), std::string::npos) << command;
    const ProgramResult own = run_program({"db", command, "--help"});
    EXPECT_EQ(own.exit_code, 0) << command;
    EXPECT_NE(own.output.find("Example:\n  remomask db " + command), std::string::npos)
        << own.output;
  }
  EXPECT_EQ(run_program({"db"}).exit_code, 2);
}

TEST_F(DbCommandsTest, BrokenFilesLeaveNoDatabaseBehind) {
  const std::string broken = scratch_ / "walk.bvh", fresh = scratch_ / "new.sqlite";
  std::ofstream(broken) << "HIERARCHY\nROOT";
  const std::string folder = scratch_ / "broken";
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(broken, folder + "/walk.bvh");
  EXPECT_EQ(run_program({"db", "add", fresh, broken}).exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(fresh));
  EXPECT_EQ(run_program({"import", scratch_ / "nowhere", "--db", fresh}).exit_code, 1);
  EXPECT_FALSE(std::filesystem::exists(fresh));
  EXPECT_EQ(run_json({"import", folder, "--db", fresh})["rejected"].size(), 1u);
  for (const char* ending : {"", "-wal", "-shm", "-journal"}) {
    EXPECT_FALSE(std::filesystem::exists(fresh + ending)) << ending;
  }
  // A database that was there stays.
  EXPECT_EQ(run_program({"db", "add", database_, broken}).exit_code, 1);
  EXPECT_EQ(count({}), 12u);
}

TEST_F(DbCommandsTest, TagsAndFiltersChooseClips) {
  EXPECT_EQ(run_json({"db", "tag", database_, name(0), "#" + std::to_string(int(clips_[1]["id"])),
                      "--add", "good", "--add", "new", "--set-label", "mark=7"})["changed"],
            2);
  EXPECT_EQ(count({"--tag", "good"}), 2u);
  EXPECT_EQ(count({"--label", "mark=7"}), 2u);
  EXPECT_EQ(
      run_json({"db", "tag", database_, "--tag", "good", name(0), "--drop", "new"})["changed"], 1);
  EXPECT_EQ(count({"--tag", "new"}), 1u);
  const auto shown = run_json({"db", "show", database_, name(1)})["clips"][0];
  EXPECT_EQ(shown["tags"], (nlohmann::json{"good", "new"}));
  EXPECT_EQ(shown["labels"]["mark"], 7);
  EXPECT_EQ(run_json({"db", "tag", database_, name(2), "--set-caption", "zebra dance",
                      "--set-split", "none", "--set-licence", "X"})["changed"],
            1);
  EXPECT_EQ(count({"--words", "dancing zebras"}), 1u);
  EXPECT_EQ(count({"--caption-query", "zeb* NOT horse"}), 1u);
  EXPECT_EQ(count({"--licence", "X", "--split", "none"}), 1u);
  const double speed = clips_[3]["speed"];
  EXPECT_GE(count({"--min-speed", std::to_string(speed - 0.001)}), 1u);
  EXPECT_EQ(count({"--min-speed", "100"}), 0u);
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"list", database_, "--tag", "bad"},
        {"list", database_, "--caption-query", "AND"},
        {"list", database_, "--words", "..."},
        {"tag", database_, name(0)},
        {"tag", database_, "--add", "x"},
        {"tag", database_, "nobody", "--add", "x"},
        {"show", database_, "99"}}) {
    std::vector<std::string> arguments = wrong;
    arguments.insert(arguments.begin(), "db");
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments[1] << result.output;
    EXPECT_EQ(result.output, "");
    EXPECT_NE(result.errors, "");
  }
}

TEST_F(DbCommandsTest, AttributionsAreShownByInfo) {
  EXPECT_EQ(run_json({"db", "info", database_})["attributions"], nlohmann::json::object());
  run_json({"db", "attribute", database_, "procedural", "made by\nformula"});
  EXPECT_EQ(run_json({"db", "info", database_})["attributions"],
            (nlohmann::json{{"procedural", "made by\nformula"}}));
  const std::string shown = run_program({"db", "info", database_}).output;
  EXPECT_NE(shown.find("made by"), std::string::npos) << shown;
  const ProgramResult wrong = run_program({"db", "attribute", database_, "nobody", "x"});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_NE(wrong.errors.find("data set 'nobody'"), std::string::npos) << wrong.errors;
  EXPECT_EQ(run_program({"db", "attribute", database_, "procedural", "\xff"}).exit_code, 1);
  run_json({"db", "attribute", database_, "procedural", ""});
  EXPECT_EQ(run_json({"db", "info", database_})["attributions"], nlohmann::json::object());
}

TEST_F(DbCommandsTest, ActionsOfMadeMotionsAreInTheVocabularyOfThePacks) {
  const std::string all = scratch_ / "all.sqlite";
  run_json({"procedural", "--db", all, "--count", "59"});
  const auto found = [&](std::vector<std::string> conditions) {
    std::vector<std::string> arguments = {"db", "list", all};
    for (const std::string& condition : conditions) {
      arguments.insert(arguments.end(), {"--label", condition});
    }
    return run_json(arguments)["clips"].size();
  };
  EXPECT_EQ(found({"actions=punch"}), 3u);
  EXPECT_EQ(found({"actions=fight", "actions=front kick"}), 2u);
  EXPECT_EQ(found({"actions=jumping jacks"}), 1u);
  EXPECT_EQ(found({"actions=turn left", "actions=turn around"}), 1u);
  EXPECT_EQ(found({"actions=raise hand"}), 3u);
  const ProgramResult wrong = run_program({"db", "list", all, "--label", "actions=jumpin jacks"});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_NE(
      wrong.errors.find("values that begin alike: jump, jump forward, jump high, jumping jacks"),
      std::string::npos)
      << wrong.errors;
}

TEST_F(DbCommandsTest, DigitsAreNamesAndNumbersHaveASign) {
  const std::string number = std::to_string(int(clips_[1]["id"]));
  const ProgramResult refused = run_program({"db", "remove", database_, number});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.errors.find("write #" + number + " for clip number " + number),
            std::string::npos)
      << refused.errors;
  EXPECT_EQ(run_json({"db", "show", database_, "#" + number})["clips"][0]["name"], name(1));
  const ProgramResult removed = run_program({"db", "remove", database_, "#" + number});
  EXPECT_EQ(removed.output,
            "removed " + name(1) + "\n" + database_ + ": 1 clip removed, 11 clips left\n");
}

TEST_F(DbCommandsTest, RemoveAsksBeforeItTakesSeveral) {
  const ProgramResult asked = run_program({"db", "remove", database_, "--min-seconds", "0"});
  EXPECT_EQ(asked.exit_code, 1);
  EXPECT_NE(asked.errors.find("would remove 12 clips"), std::string::npos) << asked.errors;
  EXPECT_NE(asked.errors.find("--yes"), std::string::npos);
  EXPECT_EQ(run_program({"db", "remove", database_, "--yes"}).exit_code, 1);
  EXPECT_EQ(count({}), 12u);
  EXPECT_EQ(run_json({"db", "remove", database_, name(0)})["removed"], nlohmann::json{name(0)});
  // Listing the names is the confirmation.
  const auto removed = run_json({"db", "remove", database_, name(1), name(2)});
  EXPECT_EQ(removed["clips_left"], 9);
  EXPECT_EQ(count({}), 9u);
}

TEST_F(DbCommandsTest, DryRunShowsWhatRemoveWouldTake) {
  const ProgramResult shown =
      run_program({"db", "remove", database_, "--licence", "MIT", "--dry-run"});
  EXPECT_EQ(shown.exit_code, 0) << shown.errors;
  EXPECT_NE(shown.output.find("would remove " + name(0) + "\n"), std::string::npos);
  EXPECT_NE(shown.output.find("12 clips would be removed, 0 clips left"), std::string::npos)
      << shown.output;
  const auto json = run_json({"db", "remove", database_, name(0), "--dry-run"});
  EXPECT_EQ(json["would_remove"], nlohmann::json{name(0)});
  EXPECT_EQ(json["clips_left"], 11);
  EXPECT_EQ(count({}), 12u);
}

TEST_F(DbCommandsTest, SeveralFoldersAreImportedAtOnce) {
  const std::string one = scratch_ / "one", two = scratch_ / "two";
  const std::string all = scratch_ / "all.sqlite";
  run_json({"db", "export", database_, one, name(0), name(1)});
  run_json({"db", "export", database_, two, name(2)});
  std::ofstream(two + "/broken.bvh") << "HIERARCHY\nROOT";
  // What is wrong with one of them is said before anything is stored.
  for (const auto& [arguments, what] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{one, scratch_ / "nowhere"}, "nowhere: there is no such folder"},
           {{one, one + "/."}, "a data set 'one' is named before it"},
           {{one, two, "--source", "s"}, "--source is about one folder"},
           {{one, two, "--captions", one + "/captions.jsonl"}, "--captions is about one folder"}}) {
    std::vector<std::string> command = {"import", "--db", all};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const ProgramResult refused = run_program(command);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.errors.find(what), std::string::npos) << refused.errors;
    EXPECT_FALSE(std::filesystem::exists(all));
  }
  const auto report = run_json({"import", one, two, "--db", all});
  EXPECT_EQ(report["files_stored"], 3);
  ASSERT_EQ(report["rejected"].size(), 1u);
  EXPECT_EQ(report["rejected"][0]["folder"], two);
  EXPECT_EQ(run_json({"db", "info", all})["sources"], (nlohmann::json{{"one", 2}, {"two", 1}}));
  const std::string again = run_program({"import", one, two, "--db", all}).output;
  EXPECT_NE(again.find(one + ":\n0 of 2 files stored now, 2 stored before"), std::string::npos)
      << again;
}

TEST_F(DbCommandsTest, ANameOfDigitsIsThatClip) {
  const std::string out = scratch_ / "out";
  run_json({"db", "export", database_, out, name(0)});
  run_json({"db", "remove", database_, name(0)});
  std::filesystem::rename(out + "/" + name(0) + ".npy", out + "/000002.npy");
  run_json({"db", "add", database_, out + "/000002.npy", "--add-caption", "digits"});
  EXPECT_EQ(run_json({"db", "show", database_, "000002"})["clips"][0]["captions"],
            nlohmann::json{"digits"});
  EXPECT_EQ(run_json({"db", "remove", database_, "000002"})["removed"], nlohmann::json{"000002"});
  // Now that it is gone, clip number 2 must not go in its place.
  const ProgramResult refused = run_program({"db", "remove", database_, "000002"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.errors.find("there is no clip named"), std::string::npos) << refused.errors;
  EXPECT_NE(refused.errors.find("write #2"), std::string::npos) << refused.errors;
  EXPECT_EQ(count({}), 11u);
}

TEST_F(DbCommandsTest, CaptionsAreAddedOrReplaced) {
  const auto captions = [&] {
    return run_json({"db", "show", database_, name(0)})["clips"][0]["captions"];
  };
  nlohmann::json expected = captions();
  expected.push_back("one more");
  run_json({"db", "tag", database_, name(0), "--add-caption", "one more"});
  EXPECT_EQ(captions(), expected);
  EXPECT_EQ(run_json({"db", "tag", database_, name(0), "--add-caption", "one more"})["changed"], 0);
  run_json({"db", "tag", database_, name(0), "--set-caption", "new", "--add-caption", "newer"});
  EXPECT_EQ(captions(), (nlohmann::json{"new", "newer"}));
}

TEST_F(DbCommandsTest, InfoRoundsAndLeavesNoFilesBeside) {
  const ProgramResult info = run_program({"db", "info", database_});
  const size_t at = info.output.find("minutes ");
  ASSERT_NE(at, std::string::npos) << info.output;
  const std::string line = info.output.substr(at, info.output.find('\n', at) - at);
  EXPECT_LE(line.size() - line.find_last_of(' '), 5u) << line;
  EXPECT_TRUE(run_json({"db", "info", database_})["minutes"].is_number());
  for (const char* ending : {"-wal", "-shm"}) {
    EXPECT_FALSE(std::filesystem::exists(database_ + ending)) << ending;
  }
}

TEST_F(DbCommandsTest, ExportMergeAddAndCheckWorkTogether) {
  const std::string out = scratch_ / "out", again = scratch_ / "again.sqlite";
  EXPECT_EQ(run_json({"db", "export", database_, out})["clips"], 12);
  EXPECT_EQ(run_json({"import", out, "--db", again})["clips_stored"], 12);
  EXPECT_EQ(run_json({"db", "merge", again, database_})["duplicates"].size(), 12u);
  const std::string few = scratch_ / "few";
  run_json({"db", "export", database_, few, name(0), name(1), "--format", "bvh"});
  run_json({"db", "remove", database_, name(0)});
  const auto added = run_json({"db", "add", database_, few + "/" + name(0) + ".bvh", "--caption",
                               "back again", "--tag", "t", "--label", "a=b", "--split", "val"});
  EXPECT_EQ(added["clips"][0]["name"], name(0));
  const ProgramResult twice =
      run_program({"db", "add", database_, few + "/" + name(0) + ".bvh", "--json"});
  EXPECT_EQ(twice.exit_code, 1);
  EXPECT_EQ(nlohmann::json::parse(twice.output)["rejected"].size(), 1u);
  EXPECT_TRUE(run_json({"db", "check", database_})["defects"].empty());
  const auto info = run_json({"db", "info", database_});
  EXPECT_EQ(info["clips"], 12);
  EXPECT_EQ(info["tags"]["t"], 1);
}

TEST_F(DbCommandsTest, SnapshotRestoreUpgrade) {
  const std::string copy = scratch_ / "copy.sqlite";
  run_json({"db", "snapshot", database_, copy});
  EXPECT_EQ(run_program({"db", "snapshot", database_, copy}).exit_code, 1);
  run_json({"db", "remove", database_, name(0)});
  const ProgramResult refused = run_program({"db", "restore", copy, database_});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.errors.find("--force"), std::string::npos);
  EXPECT_EQ(count({}), 11u);
  run_json({"db", "restore", copy, database_, "--force"});
  EXPECT_EQ(count({}), 12u);
  EXPECT_EQ(run_json({"db", "upgrade", database_})["version"], 7);
}

}  // namespace
}  // namespace remomask
