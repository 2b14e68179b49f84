// The command `search` on the shipped model and database.
#include <gtest/gtest.h>

#include <filesystem>

#include "base/file.h"
#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

const std::string kStored = "procedural-walk-circle-left-000";

std::string failure(const std::vector<std::string>& arguments) {
  const ProgramResult result = run_program(arguments);
  EXPECT_EQ(result.exit_code, 1) << result.output;
  EXPECT_EQ(result.output, "");
  return result.errors;
}

TEST(SearchCommand, FindsByMotionPartsAndBoth) {
  const auto alike = run_json({"search", "--like-clip", kStored, "-k", "3"});
  ASSERT_EQ(alike["hits"].size(), 3u);
  EXPECT_EQ(alike["like_clip"], kStored);
  EXPECT_EQ(alike["hits"][0]["clip"], "procedural-walk-circle-left-003");
  for (const auto& hit : alike["hits"]) {
    EXPECT_NE(hit["clip"], kStored);
    EXPECT_EQ(hit["folded"], 0);
  }
  const auto shipped =
      run_json({"info", std::string(REMOMASK_SOURCE_DIR) + "/models/motions.sqlite"});
  const int others = shipped["clips"].get<int>() - 1;
  const auto arms = run_json({"search", "--like-clip", kStored, "--parts", "arms", "--ungrouped",
                              "-k", std::to_string(others)});
  EXPECT_EQ(arms["hits"].size(), static_cast<size_t>(others));
  const auto both = run_json({"search", "a person jumps", "--like-clip", kStored, "--text-weight",
                              "1", "--motion-weight", "0", "-k", "1"});
  EXPECT_NE(both["hits"][0]["captions"].dump().find("jump"), std::string::npos);
}

TEST(SearchCommand, ReadsMotionFilesAndPiecesOfThem) {
  const TestFolder scratch;
  run_json({"db", "export", std::string(REMOMASK_SOURCE_DIR) + "/models/motions.sqlite",
            scratch / "clips", kStored, "--format", "npy"});
  const std::string walk = scratch / ("clips/" + kStored + ".npy");
  const auto whole = run_json({"search", "--like", walk, "-k", "1"});
  EXPECT_EQ(whole["hits"][0]["clip"], kStored);  // a file knows nothing of the clip it was
  EXPECT_GT(whole["hits"][0]["similarity"], 0.999);
  const auto piece = run_json({"search", "--like", walk, "--from", "1", "--to", "3", "-k", "1"});
  EXPECT_LT(piece["hits"][0]["similarity"], whole["hits"][0]["similarity"]);
  const auto captions = run_json({"search", "--like", walk, "--captions", "-k", "4"});
  ASSERT_EQ(captions["captions"].size(), 4u);
  EXPECT_FALSE(captions["captions"][0]["clips"].empty());
  EXPECT_NE(failure({"search", "--like", walk, "--from", "9"}).find("9"), std::string::npos);
}

TEST(SearchCommand, SaysWhenNothingFits) {
  const ProgramResult none = run_program({"search", "a walk", "--min-similarity", "1"});
  EXPECT_EQ(none.exit_code, 0);
  EXPECT_NE(none.output.find("nothing fits"), std::string::npos) << none.output;
  const auto json = run_json({"search", "a walk", "--min-similarity", "1"});
  EXPECT_TRUE(json["hits"].empty());
  EXPECT_LT(json["refused"]["similarity"], 1);
  const ProgramResult filtered = run_program({"search", "a walk", "--min-seconds", "500"});
  EXPECT_EQ(filtered.exit_code, 0);
  EXPECT_NE(filtered.output.find("no clip passes the filters"), std::string::npos);
}

TEST(SearchCommand, RefusesBadQueriesClearly) {
  const TestFolder scratch;
  const std::string stranger = scratch / "stranger.bvh";
  write_file_atomically(stranger,
                        "HIERARCHY\nROOT snake\n{\n  OFFSET 0 0 0\n  CHANNELS 6 Xposition "
                        "Yposition Zposition Zrotation Xrotation Yrotation\n  End Site\n  {\n    "
                        "OFFSET 0 1 0\n  }\n}\nMOTION\nFrames: 2\nFrame Time: 0.05\n0 0 0 0 0 0\n0 "
                        "0 0 0 0 0\n");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"search"}, "nothing to look for"},
      {{"search", ""}, "nothing to look for"},
      {{"search", " . "}, "empty"},
      {{"search", "walk", "--parts", "arms"}, "--like"},
      {{"search", "--like-clip", kStored, "--parts", "tail"}, "'tail'"},
      {{"search", "--like-clip", "nobody"}, "'nobody'"},
      {{"search", "--like", stranger}, "stranger.bvh"},
      {{"search", "--like", scratch / "missing.bvh"}, "missing.bvh"},
      {{"search", "walk", "--like-clip", kStored, "--text-weight", "0", "--motion-weight", "0"},
       "both zero"},
      {{"search", "walk", "--from", "1"}, "--like"},
      {{"search", "walk", "--captions"}, "captions are looked up for"},
      {{"search", "--", "-walk -run"}, "not wanted"},
      {{"search", "walk", "--boost-words", "slow"}, "--by motion"},
      {{"search", "walk", "--by", "motion", "--boost-words", "..."}, "no word"},
      {{"search", "walk", "--min-probability", "2"}, "not a probability"},
      {{"search", "walk", "--by", "motion", "--min-probability", "0.5"}, "evaluate calibration"},
      {{"search", "--like-clip", kStored, "--parts", "arms", "--moments"}, "whole body"},
  };
  for (const auto& [arguments, expected] : cases) {
    const std::string message = failure(arguments);
    EXPECT_NE(message.find(expected), std::string::npos) << expected << " in " << message;
  }
}

TEST(SearchCommand, SaysWhichLanguageItDoesNotUnderstand) {
  const ProgramResult spanish = run_program({"search", "una persona camina", "-k", "2"});
  EXPECT_EQ(spanish.exit_code, 0);
  EXPECT_NE(spanish.output.find("this looks like Spanish"), std::string::npos) << spanish.output;
  EXPECT_EQ(run_json({"search", "una persona camina"})["language"], "Spanish");
  EXPECT_FALSE(run_json({"search", "a person walks"}).contains("language"));
  EXPECT_NE(failure({"search", "\xf0\x9f\x91\x8b"}).find("no word"), std::string::npos);
}

TEST(SearchCommand, FindsWhatWasGuessedAndSaysSo) {
  const TestFolder scratch;
  const std::string database = scratch / "motions.sqlite", wave = scratch / "unnamed.bvh";
  std::filesystem::copy_file(std::string(REMOMASK_SOURCE_DIR) + "/models/motions.sqlite", database);
  std::filesystem::permissions(database, std::filesystem::perms::owner_write,
                               std::filesystem::perm_options::add);
  run_json({"generate", "a person waves with the right hand", "--seconds", "3", "--seed", "3", "-o",
            wave});
  run_json({"db", "add", database, wave});
  run_json({"index", database});
  const auto made = run_json({"db", "describe", database, "--min-probability", "0.05"});
  ASSERT_EQ(made["described"].size(), 1u) << made;
  EXPECT_EQ(made["described"][0]["clip"], "unnamed");
  const auto& captions = made["described"][0]["captions"];
  EXPECT_EQ(run_json({"db", "show", database, "unnamed"})["clips"][0]["guessed_captions"],
            captions);
  const auto found =
      run_json({"search", captions[0]["text"], "--db", database, "-k", "100", "--ungrouped"});
  bool seen = false;
  for (const auto& hit : found["hits"]) {
    EXPECT_EQ(hit["parts"].contains("guess"), hit["clip"] == "unnamed");
    if (hit["clip"] != "unnamed") continue;
    seen = true;
    EXPECT_TRUE(hit["captions"].empty());
    EXPECT_EQ(hit["parts"]["guess"], captions[0]["probability"]);
    EXPECT_LE(hit["probability"], captions[0]["probability"].get<double>() + 0.1);
  }
  EXPECT_TRUE(seen);
  const auto accepted = run_json({"db", "describe", database, "unnamed", "--accept"});
  EXPECT_EQ(accepted["accepted"][0]["caption"], captions[0]["text"]);
  EXPECT_EQ(run_json({"db", "describe", database, "--remove"})["removed"], 0);
}

}  // namespace
}  // namespace remomask
