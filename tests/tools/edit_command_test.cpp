// The command edit, generate --script and candidates, on the shipped files.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "base/file.h"
#include "tests/tools/program_runner.h"

namespace remomask {
namespace {

/// Coordinates of an npy file of float32 [frames, 22, 3] without its header.
std::vector<float> read_joints(const std::string& path) {
  const std::string content = read_file(path);
  const size_t header =
      10 + static_cast<unsigned char>(content[8]) + 256u * static_cast<unsigned char>(content[9]);
  std::vector<float> values((content.size() - header) / sizeof(float));
  std::memcpy(values.data(), content.data() + header, values.size() * sizeof(float));
  return values;
}

/// Largest difference in the joints that `kept` names, over frames [first, last).
template <class Kept>
double difference(const std::vector<float>& a, const std::vector<float>& b, int first, int last,
                  const Kept& kept) {
  double largest = 0;
  for (int t = first; t < last; ++t) {
    for (int j = 0; j < 22; ++j) {
      if (!kept(j)) continue;
      for (size_t axis = 0; axis < 3; ++axis) {
        const size_t i = (static_cast<size_t>(t) * 22 + static_cast<size_t>(j)) * 3 + axis;
        largest = std::max<double>(largest, std::abs(a[i] - b[i]));
      }
    }
  }
  return largest;
}

class EditCommandTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TestFolder;
    for (const char* file : {"walk.npy", "walk.bvh"}) {
      run_json({"generate", "a person walks forward", "--seconds", "4.15", "--seed", "1", "-o",
                path(file)});
    }
  }
  static void TearDownTestSuite() {
    delete scratch_;
    scratch_ = nullptr;
  }
  static std::string path(const std::string& name) { return *scratch_ / name; }

  static TestFolder* scratch_;
};

TestFolder* EditCommandTest::scratch_ = nullptr;

TEST_F(EditCommandTest, WhatIsNotNamedStaysBitForBit) {
  const auto made = run_json({"edit", path("walk.npy"), "--prompt", "someone waves", "--span",
                              "1-2.5", "--parts", "left_arm", "-o", path("arm.npy")});
  const auto before = read_joints(path("walk.npy")), after = read_joints(path("arm.npy"));
  ASSERT_EQ(before.size(), after.size());
  EXPECT_EQ(before.size(), 83u * 66u);  // 4.15 s
  const auto arm = [](int j) { return j == 13 || j == 16 || j == 18 || j == 20; };
  const auto rest = [&](int j) { return !arm(j); };
  const auto all = [](int) { return true; };
  EXPECT_EQ(difference(before, after, 0, 20, all), 0);
  EXPECT_EQ(difference(before, after, 50, 83, all), 0);
  EXPECT_EQ(difference(before, after, 20, 50, rest), 0);
  EXPECT_GT(difference(before, after, 20, 50, arm), 0.01);
  const auto& cells = made["motions"][0]["edit"]["cells"];
  ASSERT_EQ(cells.size(), 1u);
  EXPECT_EQ(cells[0]["part"], "left_arm");
  EXPECT_EQ(cells[0]["first"], 20);
  EXPECT_EQ(cells[0]["last"], 50);
}

TEST_F(EditCommandTest, BvhKeepsWhatIsNotNamed) {
  run_json({"edit", path("walk.bvh"), "--prompt", "someone jumps", "--span", "1.5-3", "-o",
            path("jump.bvh")});
  run_json({"edit", path("walk.bvh"), "--prompt", "someone jumps", "--span", "1.5-3", "-o",
            path("jump.npy")});
  // The same edit in the other format. The walk was on the skeleton of BVH files already; what is
  // generated between is put onto it.
  run_json({"edit", path("jump.bvh"), "--prompt", "nothing", "--span", "0-0.05", "--parts",
            "left_arm", "-o", path("back.npy")});
  const auto exact = read_joints(path("jump.npy")), back = read_joints(path("back.npy"));
  const auto all = [](int) { return true; };
  EXPECT_LT(difference(exact, back, 1, 29, all), 2e-4);
  EXPECT_LT(difference(exact, back, 61, 83, all), 2e-4);
  EXPECT_LT(difference(exact, back, 29, 61, all), 0.05);
}

TEST_F(EditCommandTest, ContinuesToTheFrame) {
  const auto made = run_json({"edit", path("walk.npy"), "--prompt", "a person runs", "--extend",
                              "2.35", "-o", path("longer.npy")});
  EXPECT_EQ(made["motions"][0]["frames"], 83 + 47);
  const auto before = read_joints(path("walk.npy")), after = read_joints(path("longer.npy"));
  EXPECT_EQ(difference(before, after, 0, 83, [](int) { return true; }), 0);
}

TEST_F(EditCommandTest, TheBestOfSeveralIsKept) {
  const auto made =
      run_json({"edit", path("walk.npy"), "--prompt", "someone waves", "--cells", "1-2:arms",
                "--cells", "3-end:right_leg", "--best-of", "3", "-o", path("best.npy")});
  const auto& candidates = made["motions"][0]["segments"][0]["candidates"];
  ASSERT_EQ(candidates.size(), 3u);
  EXPECT_GE(candidates[0]["score"].get<double>(), candidates[1]["score"].get<double>());
  EXPECT_GE(candidates[1]["score"].get<double>(), candidates[2]["score"].get<double>());
  EXPECT_EQ(made["motions"][0]["edit"]["cells"].size(), 3u);
  const auto chosen = run_json(
      {"generate", "someone jumps", "--seconds", "2", "--best-of", "3", "-o", path("jump3.npy")});
  const auto& ranking = chosen["motions"][0]["segments"][0]["candidates"];
  run_json({"generate", "someone jumps", "--seconds", "2", "--seed",
            ranking[0]["seed"].get<std::string>(), "-o", path("jump1.npy")});
  EXPECT_EQ(read_joints(path("jump3.npy")), read_joints(path("jump1.npy")));
}

TEST_F(EditCommandTest, LengthsAreEstimated) {
  for (const std::string rule : {"likely", "sample", "evidence"}) {
    const auto made = run_json(
        {"generate", "a person bows", "--length", rule, "--seed", "2", "-o", path("bow.npy")});
    const auto& motion = made["motions"][0];
    EXPECT_EQ(motion["length"]["rule"], rule);
    EXPECT_GE(motion["frames"].get<int>(), 20);
    if (rule == "likely") {
      EXPECT_NEAR(motion["length"]["likely_seconds"].get<double>() * 20,
                  motion["frames"].get<int>(), 1e-6);
    }
  }
}

TEST_F(EditCommandTest, ScriptsBecomeOneMotion) {
  write_file_atomically(path("script.txt"),
                        "# two sentences\n2.3  a person walks forward\n1.6 someone waves\n");
  const auto made =
      run_json({"generate", "--script", path("script.txt"), "-o", path("s.npy")})["motions"][0];
  EXPECT_EQ(made["frames"], 46 + 32);
  EXPECT_EQ(made["segments"].size(), 2u);
  EXPECT_EQ(made["segments"][1]["first"], 46);
  EXPECT_FALSE(made["segments"][0]["evidence"].empty());
  EXPECT_GT(made["script"]["seams_to_real"].get<double>(), 0);
  EXPECT_EQ(read_joints(path("s.npy")).size(), 78u * 66u);
  write_file_atomically(path("bad.txt"), "walk\n0.2 run\n");
  const ProgramResult bad =
      run_program({"generate", "--script", path("bad.txt"), "-o", path("b.npy")});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_NE(bad.errors.find("bad.txt:2"), std::string::npos) << bad.errors;
}

TEST_F(EditCommandTest, MistakesAreNamed) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--span", "3-2"}, "3-2"},    {{"--span", "1-9"}, "4.15"},
      {{"--span", "one-2"}, "one"},  {{"--span", "2"}, "BEGIN-END"},
      {{"--parts", "tail"}, "tail"}, {{"--cells", "1-2:tail"}, "tail"},
      {{}, "nothing to edit"},
  };
  for (const auto& [arguments, expected] : cases) {
    std::vector<std::string> command = {"edit", path("walk.npy"), "--prompt", "walk",
                                        "-o",   path("wrong.npy")};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const ProgramResult result = run_program(command);
    EXPECT_EQ(result.exit_code, 1) << expected;
    EXPECT_NE(result.errors.find(expected), std::string::npos) << result.errors;
  }
  EXPECT_EQ(run_program({"generate", "-o", path("x.bvh")}).exit_code, 2);
  EXPECT_EQ(run_program({"generate", "walk", "--script", "s", "-o", path("x.bvh")}).exit_code, 1);
}

}  // namespace
}  // namespace remomask
